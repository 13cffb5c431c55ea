//! Appends to a journal, which nobody else may do at the same time.

use super::header::Header;
use super::kept::Kept;
use super::line::Line;
use super::scan::scan;
use crate::experiment::error::Error;
use crate::experiment::guard::Failure;
use crate::experiment::unit::Unit;
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, Seek, SeekFrom, Write};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::thread;
use std::time::{Duration, Instant};

/// What to do with a journal that is there.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Start {
    /// Go on from it where it is of the same run. One of another run that came to its end is replaced, as its report is; of one
    /// that did not nothing is touched.
    #[default]
    Either,
    /// Go on from it; it must be there.
    Resume,
    /// Start over.
    Fresh,
}

/// A journal that is written.
#[derive(Debug)]
pub struct Journal {
    path: PathBuf,
    file: File,
    waiting: Vec<u8>,
    since: Instant,
    /// What it held when it was opened.
    pub kept: Kept,
    /// Seconds that earlier runs spent on each cell.
    pub seconds: Vec<f64>,
    /// What is to be told of how it was found.
    pub told: Vec<String>,
}

/// Work is in the file after this at the latest.
const BATCH: Duration = Duration::from_secs(1);

/// Waiting bytes that are written without waiting any longer.
const MOST: usize = 1 << 22;

impl Journal {
    /// Opens the journal of a run in `folder`, whose last line may be torn, and locks it until it is dropped or this process
    /// ends, however it ends.
    ///
    /// # Errors
    ///
    /// When another process has it, or it is of another run, or cannot be read or written.
    pub fn open(folder: &Path, header: &Header, start: Start) -> Result<Self, Error> {
        fs::create_dir_all(folder).map_err(|e| Error::io("cannot create the folder", folder, e))?;
        let path = folder.join(header.shard.file());
        let failed = |e| Error::io("cannot write", &path, e);
        let mut options = OpenOptions::new();
        let file = options.read(true).write(true).create(true).truncate(false).open(&path).map_err(failed)?;
        lock(&file, &path)?;
        let mut journal = Journal {
            path,
            file,
            waiting: Vec::new(),
            since: Instant::now(),
            kept: Kept::default(),
            seconds: vec![0.0; header.cells.len()],
            told: Vec::new(),
        };
        if !journal.goes_on(header, start)? {
            journal.file.set_len(0).map_err(|e| journal.failed(e))?;
            journal.append_header(header)?;
        }
        journal.kept.cells(header.cells.len());
        Ok(journal)
    }

    /// The file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Whether it is gone on from; if so, its end is where the next line goes.
    fn goes_on(&mut self, header: &Header, start: Start) -> Result<bool, Error> {
        let is_new = self.file.metadata().map_err(|e| self.failed(e))?.len() == 0;
        match start {
            Start::Resume if is_new => {
                fs::remove_file(&self.path).map_err(|e| self.failed(e))?;
                let why = format!("there is no {} to go on from", self.path.display());
                return Err(Error::Refused(why));
            }
            _ if is_new || start == Start::Fresh => return Ok(false),
            _ => {}
        }
        let found = scan(&self.path)?;
        if let Some(difference) = header.difference(&found.header) {
            if found.ended && start == Start::Either {
                self.told.push(format!("{} starts over: {difference}", self.path.display()));
                return Ok(false);
            }
            return Err(Error::Refused(format!(
                "{} is of another run: {difference}; --fresh starts over, --out keeps both",
                self.path.display()
            )));
        }
        self.told.extend(found.damage.told(&self.path));
        self.file.set_len(found.damage.end).map_err(|e| self.failed(e))?;
        self.file.seek(SeekFrom::End(0)).map_err(|e| self.failed(e))?;
        self.seconds.clone_from(&found.seconds);
        let is_same = found.header == *header;
        (self.kept, _) = Kept::join(vec![found])?;
        if !is_same {
            self.append_header(header)?;
        }
        Ok(true)
    }

    fn append_header(&mut self, header: &Header) -> Result<(), Error> {
        let json = serde_json::to_vec(header).expect("names and numbers have a JSON form");
        Line::Header(&json).write(&mut self.waiting);
        self.flush()
    }

    /// Appends the blocks `numbers` of a cell, whose records are given, and to which their pixels are added.
    pub fn blocks(
        &mut self,
        cell: usize,
        numbers: Range<u64>,
        records: &mut Vec<u8>,
        unit: &Unit,
    ) -> Result<(), Error> {
        unit.write_pixels(records);
        Line::Blocks { cell, numbers, bytes: records }.write(&mut self.waiting);
        self.flush_if_due()
    }

    /// Notes that a block could not be made.
    pub fn failure(&mut self, cell: usize, failure: &Failure) -> Result<(), Error> {
        Line::Failed(cell, failure.clone()).write(&mut self.waiting);
        self.flush_if_due()
    }

    /// Notes seconds that were spent on a cell.
    pub fn spent(&mut self, cell: usize, seconds: f64) -> Result<(), Error> {
        self.seconds[cell] += seconds;
        Line::Seconds(cell, seconds).write(&mut self.waiting);
        self.flush_if_due()
    }

    /// Notes that the run came to its end.
    pub fn end(&mut self) -> Result<(), Error> {
        Line::End.write(&mut self.waiting);
        self.flush()
    }

    /// Writes what has waited for long enough.
    pub fn flush_if_due(&mut self) -> Result<(), Error> {
        let is_due = self.since.elapsed() >= BATCH;
        match self.waiting.len() {
            0 => Ok(()),
            _ if is_due => self.flush(),
            waiting if waiting >= MOST => self.write(),
            _ => Ok(()),
        }
    }

    /// Writes all that waits, to the disk itself.
    pub fn flush(&mut self) -> Result<(), Error> {
        self.write()?;
        self.file.sync_data().map_err(|e| self.failed(e))?;
        self.since = Instant::now();
        self.is_there()
    }

    fn write(&mut self) -> Result<(), Error> {
        self.file.write_all(&self.waiting).map_err(|e| self.failed(e))?;
        self.waiting.clear();
        Ok(())
    }

    /// A file that was removed can be written without an error, and all of it is lost.
    fn is_there(&self) -> Result<(), Error> {
        #[cfg(unix)]
        {
            use std::os::unix::fs::MetadataExt;
            if self.file.metadata().map_err(|e| self.failed(e))?.nlink() == 0 {
                return Err(self
                    .failed(io::Error::new(io::ErrorKind::NotFound, "it was removed while it was written")));
            }
        }
        Ok(())
    }

    fn failed(&self, error: io::Error) -> Error {
        Error::io("cannot write", &self.path, error)
    }
}

/// Another process may be about to end, or only look whether this one is there.
const LOCK_TRIES: u32 = 20;

/// What another process holds is left alone.
fn lock(file: &File, path: &Path) -> Result<(), Error> {
    for _ in 0..LOCK_TRIES {
        match file.try_lock() {
            Ok(()) => return Ok(()),
            Err(TryLockError::WouldBlock) => thread::sleep(Duration::from_millis(50)),
            Err(TryLockError::Error(e)) => return Err(Error::io("cannot lock", path, e)),
        }
    }
    let why = "another process is writing it; wait for that one, or choose another --out";
    Err(Error::Refused(format!("{}: {why}", path.display())))
}

/// Whether a process writes a journal at this moment.
pub fn is_written(path: &Path) -> bool {
    File::open(path).is_ok_and(|file| matches!(file.try_lock_shared(), Err(TryLockError::WouldBlock)))
}
