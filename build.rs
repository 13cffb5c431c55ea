//! Sums up the sources that decide what is sampled, for journals: blocks of another program are not gone on from.

use std::fs;
use std::path::{Path, PathBuf};

/// Folders and files that have a say in it. What is drawn and told of the samples has none.
const SOURCES: [&str; 8] = [
    "src/sampling",
    "src/scene",
    "src/estimator",
    "src/fast",
    "src/faults",
    "src/stats",
    "src/experiment",
    "Cargo.lock",
];

fn main() {
    let mut files = Vec::new();
    for source in SOURCES {
        println!("cargo:rerun-if-changed={source}");
        collect(Path::new(source), &mut files);
    }
    files.sort();
    let mut sum = Fnv::new();
    for file in files {
        sum.add(file.to_string_lossy().replace('\\', "/").as_bytes());
        // some checkouts end lines differently
        let text: Vec<u8> = fs::read(&file).unwrap_or_default().into_iter().filter(|c| *c != b'\r').collect();
        sum.add(&text);
    }
    println!("cargo:rustc-env=FURNACE_SOURCES={:016x}", sum.0);
}

fn collect(path: &Path, files: &mut Vec<PathBuf>) {
    match fs::read_dir(path) {
        Ok(entries) => entries.flatten().for_each(|entry| collect(&entry.path(), files)),
        Err(_) => files.push(path.to_owned()),
    }
}

/// The hash of Fowler, Noll and Vo (FNV-1a, 64 bits): it is to tell honest changes apart, not to withstand anybody.
struct Fnv(u64);

impl Fnv {
    fn new() -> Self {
        Fnv(0xcbf2_9ce4_8422_2325)
    }

    fn add(&mut self, bytes: &[u8]) {
        for byte in bytes.iter().chain(&(bytes.len() as u64).to_le_bytes()) {
            self.0 = (self.0 ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3);
        }
    }
}
