//! Examples for the help of each command; all of them work.

pub const RUN: &str = "\
Examples:
  experiment rr_sweep
  experiment rr_sweep --quick
  experiment rr_sweep --filter \"furnace implicit\" --samples 65536
  experiment rr_sweep --shard 1/2 --out parts
  experiment rr_sweep --shard 2/2 --out parts
  experiment rr_sweep --set seed=7 --set grid.0.samples=65536
  experiment --all --claims --format json";

pub const LIST: &str = "\
Examples:
  experiment list
  experiment list --format json";

pub const PLAN: &str = "\
Examples:
  experiment plan rr_sweep
  experiment plan rr_sweep --margin 0.001";

pub const REPORT: &str = "\
Examples:
  experiment report rr_sweep";

pub const MERGE: &str = "\
Examples:
  experiment merge parts/rr_sweep.journal";

pub const STATUS: &str = "\
Examples:
  experiment status parts/rr_sweep.journal";

pub const NEW: &str = "\
Examples:
  experiment new my_question
  experiment new my_question --scene furnace cornell_box";

pub const RENDER: &str = "\
Examples:
  experiment render cornell_box
  experiment render cornell_box --estimator explicit --spp 64 -o out.exr";

pub const REFERENCE: &str = "\
Examples:
  experiment reference cornell_box --until-error 0.01
  experiment reference experiments/caustics.toml:caustic_glass -o glass.exr";

pub const EXPORT: &str = "\
Examples:
  experiment export furnace
  experiment export cornell_box --format mitsuba -o box.xml";

pub const SLURM: &str = "\
Examples:
  experiment slurm rr_sweep --tasks 16 --out parts
  experiment slurm rr_sweep --tasks 16 --out parts --at-once 4 --time 4:00:00 --mem 2G --sbatch=--qos=long

With --submit, both scripts are handed to sbatch at once; else what is printed does that.";

pub const SCHEMA: &str = "\
Examples:
  experiment schema
  experiment schema result";

pub const COMPLETIONS: &str = "\
Examples:
  experiment completions bash
  experiment completions fish

The script calls the program that printed it. To load it when a shell starts:
  ~/.bashrc                   source <(experiment completions bash)
  ~/.zshrc                    source <(experiment completions zsh)
  ~/.config/fish/config.fish  experiment completions fish | source
  ~/.elvish/rc.elv            eval (experiment completions elvish | slurp)
  $PROFILE of PowerShell      experiment completions powershell | Out-String | iex";
