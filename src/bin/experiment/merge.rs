//! Parts of a run, put together.

use crate::args::{Merge, Options};
use crate::files::Source;
use crate::run::{Finished, publish};
use crate::{INCOMPLETE, baseline, provenance};
use anstream::eprintln;
use furnace::experiment::journal::{self, Header, Kept, Overlap, Scan};
use furnace::experiment::{Cell, Error, Plan, resume, verdict};
use furnace::report::run::Run;
use std::ops::Range;
use std::path::PathBuf;

/// Puts the journals of some folders together, and reports as if all had been run at once.
pub fn merge(args: &Merge, options: &Options) -> Result<u8, Error> {
    let scans = scans(&args.folders)?;
    let header = common(&scans)?.clone();
    let source = Source::of_journal(&header, &args.folders[0]);
    let plan = Plan::new(&source.name, &source.file, &source.text, &header.overrides)?;
    let ours = Header::new(&plan, source.file.clone(), &source.text, header.overrides.clone(), header.shard);
    if let Some(difference) = ours.difference(&header) {
        let path = scans[0].path.display();
        return Err(Error::Refused(format!("{path} was not written by this program: {difference}")));
    }
    let wanted = baseline::wanted(&source, &plan, options)?;
    let seconds = (0..plan.cells.len()).map(|i| scans.iter().map(|scan| scan.seconds[i]).sum()).collect();
    let (mut kept, overlap) = Kept::join(scans)?;
    tell(&overlap, &plan);
    let (mut cells, mut gaps) = (Vec::new(), Vec::new());
    for (i, cell_plan) in plan.cells.iter().enumerate() {
        let is_decided = |cell: &mut Cell| verdict::is_decided(&plan, i, cell);
        match resume::join(cell_plan, i, &mut kept, &is_decided)? {
            Ok(cell) => cells.push(Some(cell)),
            Err(missing) => gaps.push((i, missing)),
        }
    }
    if !gaps.is_empty() {
        eprintln!("{}", told(&gaps, &plan));
        return Ok(INCOMPLETE);
    }
    let run = Run { seconds, ..provenance::begin(&source, &plan, options) };
    publish(&source, &plan, Finished { cells, run, wanted: &wanted }, options)
}

/// All journals of some folders, read; what is damaged is told.
fn scans(folders: &[PathBuf]) -> Result<Vec<Scan>, Error> {
    let paths = folders.iter().map(|folder| journal::all(folder)).collect::<Result<Vec<_>, _>>()?;
    let scans = journal::scan_all(&paths.concat())?;
    let damage = scans.iter().filter_map(|scan| scan.damage.told(&scan.path));
    damage.for_each(|told| eprintln!("warning: {told}"));
    Ok(scans)
}

/// The header of journals that are all of one run.
fn common(scans: &[Scan]) -> Result<&Header, Error> {
    let (first, rest) = scans.split_first().expect("a folder without journals is refused");
    for scan in rest {
        let samples = |header: &Header| header.cells.iter().map(|cell| cell.samples).collect::<Vec<_>>();
        let other = first.header.difference(&scan.header).or_else(|| {
            let (ours, theirs) = (samples(&first.header), samples(&scan.header));
            let (ours, theirs) = ours.iter().zip(&theirs).find(|(a, b)| a != b)?;
            Some(format!("the samples of a cell are {theirs} there and {ours} here"))
        });
        if let Some(difference) = other {
            let (first, path) = (first.path.display(), scan.path.display());
            return Err(Error::Refused(format!("{first} and {path} are of different runs: {difference}")));
        }
    }
    Ok(&first.header)
}

/// Says which blocks were sampled twice.
fn tell(overlap: &Overlap, plan: &Plan) {
    if let Some((cell, blocks, [one, other])) = &overlap.first {
        let label = plan.label(&plan.cells[*cell]);
        let (units, blocks) = (overlap.units, journal::named(blocks));
        eprintln!(
            "{units} lines are in two journals, with the same numbers: first {blocks} of `{label}`, in {} and {}",
            one.display(),
            other.display()
        );
    }
}

/// What is missing, cell by cell.
fn told(gaps: &[(usize, Vec<Range<u64>>)], plan: &Plan) -> String {
    const SHOWN: usize = 6;
    let mut text = "blocks are missing; run the shards that lack them again, then merge again:".to_owned();
    for (cell, missing) in gaps {
        let mut joined: Vec<Range<u64>> = Vec::new();
        for blocks in missing {
            match joined.last_mut().filter(|last| last.end == blocks.start) {
                Some(last) => last.end = blocks.end,
                None => joined.push(blocks.clone()),
            }
        }
        let mut list: Vec<String> = joined.iter().take(SHOWN).map(journal::named).collect();
        if joined.len() > SHOWN {
            list.push(format!("and {} more gaps", joined.len() - SHOWN));
        }
        let label = plan.label(&plan.cells[*cell]);
        let all = plan.cells[*cell].blocks();
        let lost: u64 = missing.iter().map(|blocks| blocks.end - blocks.start).sum();
        text.push_str(&format!("\n  {label}: {lost} of {all}: {}", list.join(", ")));
    }
    text
}
