//! What journals cost: time and bytes to keep a block beside the time to make it; and, with `--write BLOCKS SHARDS FOLDER`,
//! journals of so many blocks for `experiment merge` to be timed with.

use furnace::experiment::journal::{Header, Journal, Shard, Start};
use furnace::experiment::unit::{Unit, record};
use furnace::experiment::{CellPlan, Overrides, Plan, one_block};
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Probes with all bets and with none, images of three sizes.
const FILE: &str = r#"question = "What does it cost to keep a block?"
samples = 262_144

[[claim]]
unbiased = { alpha = 1e-3, margin = 0.01, scene = "furnace" }

# what is compared goes on to its end
[[claim]]
agree = { estimator = "implicit", roulette = "throughput", scene = "furnace", alpha = 1e-3, margin = 0.01 }

[[grid]]
scene = [{ furnace = { albedo = [0.8, 0.5, 0.2] } }, { integrating_sphere = {} }]
estimator = ["implicit"]
roulette = ["throughput"]
[[grid]]
scene = [{ cornell_box = { resolution = 128 } }]
estimator = ["explicit"]
roulette = ["throughput"]
samples = 512
"#;

fn plan(resolution: u32, overrides: &Overrides) -> Plan {
    let file = FILE.replace("128", &resolution.to_string());
    Plan::new("journal", Path::new("journal.toml"), &file, overrides).expect("the file is right")
}

fn header(plan: &Plan, overrides: &Overrides, shard: Shard) -> Header {
    Header::new(plan, PathBuf::from("journal.toml"), FILE, overrides.clone(), shard)
}

/// The blocks of a unit, their records, and the seconds that blocks and records took.
fn unit(cell: &CellPlan, first: u64, records: &mut Vec<u8>) -> (Unit, [f64; 2]) {
    let (mut unit, mut seconds) = (Unit::default(), [0.0; 2]);
    records.clear();
    for number in first..first + cell.unit() {
        let start = now();
        let block = one_block(cell, number);
        seconds[0] += (now() - start).as_secs_f64();
        let start = now();
        records.extend(record(&block));
        seconds[1] += (now() - start).as_secs_f64();
        unit.push(block);
    }
    (unit, seconds)
}

/// Time that this thread has had of a processor: while the disk is waited for, others sample.
fn now() -> Duration {
    let time = nix::time::clock_gettime(nix::time::ClockId::CLOCK_THREAD_CPUTIME_ID).expect("Linux has it");
    Duration::new(time.tv_sec() as u64, time.tv_nsec() as u32)
}

fn median(mut values: Vec<f64>) -> (f64, f64, f64) {
    values.sort_by(f64::total_cmp);
    (values[values.len() / 2], values[0], values[values.len() - 1])
}

/// Time and bytes, cell by cell.
fn cost() {
    println!("{:<40} {:>9} {:>12} {:>24}", "cell", "bytes", "ms a unit", "kept, % (least, most)");
    for (core, resolution) in
        ["textbook", "fast"].into_iter().flat_map(|core| [32, 128, 512].map(|r| (core, r)))
    {
        let overrides = Overrides { core: Some(core.parse().expect("a core")), ..Overrides::default() };
        let plan = plan(resolution, &overrides);
        // the probes are the same each time
        let first = if resolution == 32 { 0 } else { 2 };
        for (i, cell) in plan.cells.iter().enumerate().skip(first) {
            let (mut shares, mut made, mut bytes) = (Vec::new(), Vec::new(), 0);
            for _ in 0..5 {
                let folder = tempfile::tempdir().expect("a folder");
                let header = header(&plan, &overrides, Shard::WHOLE);
                let mut journal = Journal::open(folder.path(), &header, Start::Either).expect("a journal");
                let length = |journal: &Journal| fs::metadata(journal.path()).expect("it is there").len();
                let before = length(&journal);
                let (mut total, mut kept, mut units, mut records) = (0.0, 0.0, 0, Vec::new());
                // two seconds at least, so that whole batches are written
                while total < 2.0 {
                    let first = units * cell.unit();
                    let (unit, [block, record]) = unit(cell, first % cell.blocks(), &mut records);
                    let start = now();
                    journal.blocks(i, first..first + cell.unit(), &mut records, &unit).expect("room");
                    kept += record + (now() - start).as_secs_f64();
                    (total, units) = (total + block, units + 1);
                }
                let start = now();
                journal.flush().expect("room");
                kept += (now() - start).as_secs_f64();
                bytes = (length(&journal) - before) / units;
                shares.push(100.0 * kept / total);
                made.push(1e3 * total / units as f64);
            }
            let (share, least, most) = median(shares);
            let label = format!("{core} {} {}", plan.label(cell), cell.pixels);
            println!(
                "{label:<40.40} {bytes:>9} {:>12.3} {share:>10.2} ({least:.2}, {most:.2})",
                median(made).0
            );
        }
    }
}

/// Journals of shards, for a run of so many blocks of the first cell: a few blocks, again and again.
fn write(blocks: u64, shards: u64, folder: &Path) {
    let samples = Some(4096 * blocks);
    let overrides =
        Overrides { samples, filter: Some("furnace".to_owned()), force: true, ..Overrides::default() };
    let plan = plan(128, &overrides);
    let cell = &plan.cells[0];
    let one = |first| {
        let mut records = Vec::new();
        let (unit, _) = unit(cell, first, &mut records);
        (unit, records)
    };
    let made: Vec<_> = (0..64).map(one).collect();
    for number in 1..=shards {
        let shard = Shard { number, count: shards };
        let mut journal =
            Journal::open(folder, &header(&plan, &overrides, shard), Start::Fresh).expect("a journal");
        for block in (0..blocks).filter(|block| shard.owns(0, *block)) {
            let (unit, records) = &made[block as usize % made.len()];
            journal.blocks(0, block..block + 1, &mut records.clone(), unit).expect("room");
        }
        journal.end().expect("room");
    }
}

fn main() {
    let args: Vec<String> = std::env::args().collect();
    match args.iter().position(|arg| arg == "--write") {
        Some(at) => {
            let number = |i: usize| args[at + i].parse().expect("a number");
            write(number(1), number(2), Path::new(&args[at + 3]));
        }
        None => cost(),
    }
}
