//! Journals, which a crash may tear and a disk may damage.

use super::{NOWHERE, SMALL, says_where, small};
use furnace::experiment::journal::{Found, Header, Kept, Line, Shard, expected, scan};
use furnace::experiment::{Cell, Overrides};
use std::fs;
use std::path::Path;

/// A journal; and the same bytes as lines behind the header of the small experiment, with the checksums that they lack: what
/// is taken has the blocks that it says, and they can be merged.
pub fn journal(bytes: &[u8]) {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("1-of-1.journal");
    fs::write(&path, bytes).expect("room");
    if let Err(error) = scan(&path) {
        says_where(&error, &path);
    }

    let plan = small();
    let file = Path::new(NOWHERE).join("small.toml");
    let header = Header::new(&plan, file, SMALL, Overrides::default(), Shard::WHOLE);
    let mut text = Vec::new();
    Line::Header(&serde_json::to_vec(&header).expect("it has a JSON form")).write(&mut text);
    for line in bytes.split(|byte| *byte == b'\n') {
        let line = [b" ", line].concat();
        text.extend(format!("{:08x}", crc32fast::hash(&line)).as_bytes());
        text.extend(line);
        text.push(b'\n');
    }
    fs::write(&path, &text).expect("room");
    let scan = scan(&path).expect("its header is sound");
    assert_eq!(scan.damage.end + scan.damage.torn, text.len() as u64);
    let mut kept = match Kept::join(vec![scan]) {
        Ok((kept, _)) => kept,
        Err(error) => return says_where(&error, &path),
    };
    for (i, plan) in plan.cells.iter().enumerate() {
        let mut cell = Cell::default();
        for first in (0..plan.blocks()).step_by(plan.unit() as usize) {
            match kept.unit(i, plan, &expected(plan, first)) {
                Ok(Found::Unit(unit)) => {
                    let realizations: u64 = unit.blocks.iter().map(|block| block.cost.n).sum();
                    let numbers = expected(plan, first);
                    assert_eq!(realizations, (numbers.end - numbers.start) * plan.block);
                    cell.merge_unit(&unit, plan.keep());
                }
                Ok(Found::Failed(_) | Found::Missing) => {}
                Err(error) => says_where(&error, &path),
            }
        }
        cell.finish();
        assert!(cell.is_whole());
    }
}
