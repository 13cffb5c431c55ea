//! Promise: whatever happens to the bytes of a journal, a run that goes on from it has the cells of an undisturbed one, or
//! is refused; never others. What was not damaged is not sampled again.

use furnace::experiment::journal::{Header, Journal, Shard, Start, scan};
use furnace::experiment::{Cell, Error, Overrides, Plan, resume, run_cell, verdict};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

/// A probe that may end early, one that may not, and images whose blocks are kept two by two.
const FILE: &str = r#"question = "What survives?"
samples = 6400
claim = [{ unbiased = { alpha = 1e-3, margin = 0.2, scene = "furnace" } }]
[[grid]]
scene = [{ furnace = { albedo = [0.8, 0.5, 0.2] } }, "integrating_sphere"]
estimator = ["implicit"]
roulette = ["throughput"]
[[grid]]
scene = [{ cornell_box = { resolution = 8 } }]
estimator = ["explicit"]
roulette = ["throughput"]
samples = 700
"#;

fn plan() -> Plan {
    Plan::new("x", Path::new("x.toml"), FILE, &Overrides::default()).unwrap()
}

fn header(plan: &Plan) -> Header {
    Header::new(plan, PathBuf::from("x.toml"), FILE, Overrides::default(), Shard::WHOLE)
}

/// All cells, by going on from the journal in `folder`, and what was told of it.
fn go_on(plan: &Plan, folder: &Path) -> Result<(Vec<Cell>, Vec<String>), Error> {
    let mut journal = Journal::open(folder, &header(plan), Start::Either)?;
    let stop = AtomicBool::new(false);
    let mut cells = Vec::new();
    for (i, cell) in plan.cells.iter().enumerate() {
        let is_decided = |cell: &mut Cell| verdict::is_decided(plan, i, cell);
        cells.push(resume::go_on(cell, i, &mut journal, &stop, &|_| (), &is_decided)?.unwrap());
    }
    journal.flush()?;
    Ok((cells, journal.told.clone()))
}

/// All cells, as they are without a journal.
fn undisturbed(plan: &Plan) -> Vec<Cell> {
    let stop = AtomicBool::new(false);
    let one = |(i, cell)| {
        run_cell(cell, &stop, &|_| (), &|cell: &mut Cell| verdict::is_decided(plan, i, cell)).unwrap()
    };
    plan.cells.iter().enumerate().map(one).collect()
}

/// A journal of the whole run: its folder, its path and its bytes.
fn journal(plan: &Plan) -> (tempfile::TempDir, PathBuf, Vec<u8>) {
    let folder = tempfile::tempdir().unwrap();
    go_on(plan, folder.path()).unwrap();
    let path = folder.path().join("1-of-1.journal");
    let bytes = fs::read(&path).unwrap();
    (folder, path, bytes)
}

/// Numbers that look random.
fn random(n: u64) -> u64 {
    let mut z = n.wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb) >> 16
}

/// Goes on from a journal with these bytes: whether that led to the cells of an undisturbed run, or was refused.
#[track_caller]
fn survives(plan: &Plan, right: &[Cell], bytes: &[u8], what: &str) -> bool {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("1-of-1.journal"), bytes).unwrap();
    match go_on(plan, folder.path()) {
        Ok((cells, _)) => {
            assert!(cells == right, "{what}: other cells");
            true
        }
        Err(Error::Refused(why)) => {
            assert!(why.contains("1-of-1.journal"), "{what}: {why}");
            assert_eq!(
                fs::read(folder.path().join("1-of-1.journal")).unwrap(),
                bytes,
                "{what}: it was touched"
            );
            false
        }
        Err(error) => panic!("{what}: {error}"),
    }
}

/// Bytes of the first line.
fn first_line(bytes: &[u8]) -> usize {
    bytes.iter().position(|byte| *byte == b'\n').unwrap() + 1
}

#[test]
fn a_whole_journal_has_all_blocks() {
    let plan = plan();
    let (folder, path, before) = journal(&plan);
    let (cells, told) = go_on(&plan, folder.path()).unwrap();
    assert!(cells == undisturbed(&plan));
    assert!(cells[0].cost.n < plan.cells[0].samples, "a cell is to end early");
    assert!(
        plan.cells[2].unit() > 1 && !plan.cells[2].blocks().is_multiple_of(plan.cells[2].unit()),
        "a short last unit"
    );
    assert_eq!(told, [""; 0]);
    assert_eq!(fs::read(&path).unwrap(), before, "something was sampled again");
}

#[test]
fn torn_ones_go_on() {
    let plan = plan();
    let (_folder, _, bytes) = journal(&plan);
    let right = undisturbed(&plan);
    let header = first_line(&bytes);
    for n in 0..100 {
        let at = random(n) as usize % bytes.len();
        let went_on = survives(&plan, &right, &bytes[..at], &format!("torn at {at}"));
        assert_eq!(went_on, at == 0 || at >= header, "torn at {at}");
    }
    // as file systems leave it after a loss of power
    for n in 0..10 {
        let at = header + random(n) as usize % (bytes.len() - header);
        let mut zeros = bytes[..at].to_vec();
        zeros.resize(bytes.len(), 0);
        assert!(survives(&plan, &right, &zeros, &format!("zeros from {at}")));
    }
}

#[test]
fn changed_ones_go_on_or_are_refused() {
    let plan = plan();
    let (_folder, _, bytes) = journal(&plan);
    let right = undisturbed(&plan);
    let header = first_line(&bytes);
    let flips = (0..100).map(|n| random(n + 1000) as usize % bytes.len());
    for at in flips.chain((0..20).map(|n| n * header / 20)) {
        let mut changed = bytes.clone();
        changed[at] ^= 1 << (random(at as u64) % 8);
        let went_on = survives(&plan, &right, &changed, &format!("changed at {at}"));
        // a digit of the checksum has two cases
        let same = at < 8 && changed[at].eq_ignore_ascii_case(&bytes[at]);
        assert_eq!(went_on, at >= header || same, "changed at {at}");
    }
}

#[test]
fn only_what_was_damaged_is_sampled_again() {
    let plan = plan();
    let (folder, path, bytes) = journal(&plan);
    let lines = |bytes: &[u8]| bytes.iter().filter(|byte| **byte == b'\n').count();
    let before = scan(&path).unwrap();
    let mut changed = bytes.clone();
    changed[before.places[9].offset as usize + 30] ^= 4;
    fs::write(&path, &changed).unwrap();
    let (cells, told) = go_on(&plan, folder.path()).unwrap();
    assert!(cells == undisturbed(&plan));
    assert!(told.len() == 1 && told[0].contains("a line is damaged"), "{told:?}");
    let after = scan(&path).unwrap();
    // the block, and how long it took
    assert_eq!(lines(&fs::read(&path).unwrap()), lines(&bytes) + 2);
    assert_eq!(after.places.len(), before.places.len());
    // the torn end is cut off: what follows begins a line
    fs::write(&path, &bytes[..bytes.len() - 7]).unwrap();
    let (_, told) = go_on(&plan, folder.path()).unwrap();
    assert!(told.len() == 1 && told[0].contains("bytes are torn"), "{told:?}");
    assert_eq!(scan(&path).unwrap().damage.lines, 0);
}

#[test]
fn more_samples_go_on_to_what_they_would_have_been() {
    // fewer samples have smaller blocks
    for (filter, few, many) in [("furnace", 262_144, 1_048_576), ("cornell", 4_160, 16_384)] {
        let plan = |samples| {
            let filter = Some(filter.to_owned());
            let overrides = Overrides { samples: Some(samples), filter, ..Overrides::default() };
            Plan::new("x", Path::new("x.toml"), FILE, &overrides).unwrap()
        };
        let (few, many) = (plan(few), plan(many));
        let (folder, path, bytes) = journal(&few);
        let blocks = |path: &Path| scan(path).unwrap().places.len();
        let before = blocks(&path);
        let (cells, _) = go_on(&many, folder.path()).unwrap();
        assert!(cells == undisturbed(&many), "{filter}");
        assert_eq!(&fs::read(&path).unwrap()[..bytes.len()], bytes, "what was there is gone");
        let (_anew, path_anew, _) = journal(&many);
        assert!(blocks(&path) - before < blocks(&path_anew), "{filter}: all was sampled again");
        // and back
        let (cells, _) = go_on(&few, folder.path()).unwrap();
        assert!(cells == undisturbed(&few), "{filter}");
    }
}
