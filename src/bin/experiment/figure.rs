//! Figures and tables for a paper.

use crate::HELD;
use crate::args::{Format, Options};
use crate::files::{self, Source};
use clap::Args;
use furnace::experiment::store;
use furnace::experiment::{Error, verdict};
use furnace::report::figure::{self, Column};
use furnace::report::{Lookup, latex, plots};
use std::path::{Path, PathBuf};

/// What the command writes, and how one asks for it.
pub const EXAMPLES: &str = "\
Writes NAME.svg, NAME.pdf and NAME.csv of each figure, and EXPERIMENT.tex with the verdicts.

Examples:
  experiment figure rr_sweep
  experiment figure rr_sweep --figure bias --width 177mm -o paper/figures
  experiment figure rr_sweep --width 241pt --font-size 7pt

In LaTeX, \\includegraphics{bias.pdf} as it is, without a width: then the text has the size that was asked for.
What a column is wide, \\the\\columnwidth tells.";

#[derive(Args)]
pub struct Figure {
    /// The experiment, which has been run
    pub name: String,
    /// Width of the column; the default goes into one of ACM's proceedings (acmart, sigconf: 241 pt, 84.7 mm)
    #[arg(long, value_name = "LENGTH", default_value = "84mm", value_parser = length)]
    pub width: f64,
    /// Size of all text
    #[arg(long, value_name = "LENGTH", default_value = "8pt", value_parser = length)]
    pub font_size: f64,
    /// Only figures whose name contains TEXT
    #[arg(long, value_name = "TEXT")]
    pub figure: Option<String>,
    /// Where to write; figures/EXPERIMENT if left out
    #[arg(short, long, value_name = "FOLDER")]
    pub output: Option<PathBuf>,
}

/// Units of length in millimetres; pt is that of TeX.
const UNITS: [(&str, f64); 5] =
    [("mm", 1.0), ("cm", 10.0), ("in", 25.4), ("pt", 25.4 / 72.27), ("bp", 25.4 / 72.0)];

/// Millimetres.
fn length(text: &str) -> Result<f64, String> {
    let wanted =
        || "a length is a number with its unit, such as 84mm, 8.4cm, 3.33in, 241pt or 240bp".to_owned();
    let unit = UNITS.iter().find_map(|(name, size)| Some((text.strip_suffix(name)?, size)));
    let (number, size) = unit.ok_or_else(wanted)?;
    let number: f64 = number.trim().parse().map_err(|_| wanted())?;
    if number > 0.0 && number.is_finite() { Ok(number * size) } else { Err("it must be positive".to_owned()) }
}

/// Sizes of text that a reader, or a drawing of it, bears, in millimetres.
const FONT: (f64, f64) = (1.0, 20.0);
/// A figure is so many times as wide as its text is high, at least and at most.
const WIDE: (f64, f64) = (15.0, 1000.0);
/// What is higher does not fit on a page beside its caption, e.g. of ACM's proceedings; in millimetres.
const HIGH: f64 = 220.0;

fn column(args: &Figure) -> Result<Column, Error> {
    let Figure { width, font_size, .. } = *args;
    if font_size < FONT.0 || font_size > FONT.1 {
        let why = format!("--font-size is {font_size:.2} mm; it lies between {} and {} mm", FONT.0, FONT.1);
        return Err(Error::Refused(why));
    }
    let (least, most) = (WIDE.0 * font_size, WIDE.1 * font_size);
    if width < least || width > most {
        return Err(Error::Refused(format!(
            "--width is {width:.2} mm; with text of {font_size:.2} mm it lies between {least:.1} and {most:.1} mm"
        )));
    }
    Ok(Column { width, font: font_size })
}

/// Draws the figures of a stored run for a column, with their numbers, and its verdicts as a table.
pub fn figure(args: &Figure, options: &Options) -> Result<u8, Error> {
    let column = column(args)?;
    let source = Source::read(&args.name, options)?;
    let mut plan = source.plan(options)?;
    if plan.spec.seeds.is_some() {
        return Err(Error::Refused(format!("{} is a study, which has no figures", source.name)));
    }
    let stored = store::load(&source.report_folder(options), &mut plan)?;
    let rows = verdict::rows(&plan, &stored.cells);
    let lookup = Lookup::new(&plan, &rows);
    let wanted = args.figure.as_deref().unwrap_or_default();
    let all = plots::figures(&lookup, &stored.cells);
    let figures: Vec<_> = all.iter().filter(|named| named.name.contains(wanted)).collect();
    if figures.is_empty() && args.figure.is_some() {
        let names: String = all.iter().map(|named| format!("\n  {}", named.name)).collect();
        let name = &source.name;
        return Err(Error::Refused(format!(
            "no figure of {name} has `{wanted}` in its name; there are:{names}"
        )));
    }
    let folder = args.output.clone().unwrap_or_else(|| files::root().join("figures").join(&source.name));
    std::fs::create_dir_all(&folder).map_err(|e| Error::io("cannot create the output folder", &folder, e))?;
    let mut told = Vec::new();
    for plots::Named { name, figure } in figures {
        let printed = figure::print(figure, column)
            .map_err(|e| Error::io("cannot draw", Path::new(name), std::io::Error::other(e)))?;
        write(&folder, &format!("{name}.svg"), printed.svg.as_bytes())?;
        write(&folder, &format!("{name}.pdf"), &printed.pdf)?;
        write(&folder, &format!("{name}.csv"), &figure::csv(figure))?;
        told.push((name.clone(), printed.height, figure.title.clone()));
    }
    let table = format!("{}.tex", source.name);
    write(&folder, &table, latex::tables(&lookup).as_bytes())?;
    tell(&folder, &table, column, &told, options);
    Ok(HELD)
}

fn write(folder: &Path, name: &str, contents: &[u8]) -> Result<(), Error> {
    let path = folder.join(name);
    std::fs::write(&path, contents).map_err(|e| Error::io("cannot write", &path, e))
}

/// What was written: the name of each figure, its height and its title, which would make a caption.
fn tell(folder: &Path, table: &str, column: Column, figures: &[(String, f64, String)], options: &Options) {
    if options.format == Format::Json {
        let figure = |(name, height, title): &(String, f64, String)| serde_json::json!({ "name": name, "width_mm": column.width, "height_mm": height, "title": title });
        let figures: Vec<_> = figures.iter().map(figure).collect();
        let object = serde_json::json!({ "schema": 1, "folder": folder, "figures": figures, "table": table });
        println!("{object}");
        return;
    }
    for (name, height, title) in figures {
        println!("{name}: {:.1} × {height:.1} mm, {title}", column.width);
        if *height > HIGH {
            println!(
                "    higher than {HIGH} mm, too high for most pages: take a larger --width, or split the plot"
            );
        }
    }
    println!("{table}: the verdicts\nIn {}", folder.display());
}
