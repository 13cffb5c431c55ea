//! Promise: an experiment file reads nothing from outside the folder of its project, neither by an absolute path, by `..`,
//! nor by a link, unless the user allows it; and nothing that is no file, such as a pipe that would keep it waiting.

use assert_cmd::{Command, cargo::cargo_bin};
use furnace::truth::layers::Layers;
use std::fs;
use std::time::Duration;
use tempfile::TempDir;

fn experiment(file: &str) -> String {
    format!(
        "question = \"Is it inside?\"\nsamples = 64\nreference = [{{ scene = \"cornell_box\", file = \"{file}\" }}]\n[grid]\n\
         scene = [{{ cornell_box = {{ resolution = 8 }} }}]\nestimator = [\"implicit\"]\nroulette = [\"albedo\"]\n"
    )
}

fn image() -> Vec<u8> {
    let mut layers = Layers::new(8, 8);
    for (prefix, value) in [("", 1.0), ("std_error.", 0.1)] {
        ["R", "G", "B"].iter().for_each(|letter| layers.add(&format!("{prefix}{letter}"), vec![value; 64]));
    }
    layers.bytes().unwrap()
}

/// `home/project/{experiments,references}`, with images in the project and beside it.
fn home() -> TempDir {
    let home = tempfile::tempdir().unwrap();
    for folder in ["project/experiments", "project/references", "elsewhere"] {
        fs::create_dir_all(home.path().join(folder)).unwrap();
    }
    for file in ["project/references/in.exr", "project/experiments/in.exr", "elsewhere/out.exr", "out.exr"] {
        fs::write(home.path().join(file), image()).unwrap();
    }
    home
}

/// Exit status and standard error of planning, from `folder`, the experiment file `at` that names `file`.
fn plan(home: &TempDir, folder: &str, at: &str, file: &str, options: &[&str]) -> (Option<i32>, String) {
    let folder = home.path().join(folder);
    fs::write(folder.join(at), experiment(file)).unwrap();
    let mut command = Command::new(cargo_bin!("experiment"));
    command.args(["plan", at]).args(options).current_dir(folder).timeout(Duration::from_secs(30));
    let output = command.output().unwrap();
    (output.status.code(), String::from_utf8(output.stderr).unwrap())
}

#[track_caller]
fn taken(run: (Option<i32>, String)) {
    assert_eq!(run, (Some(0), String::new()));
}

#[track_caller]
fn refused(run: (Option<i32>, String), words: &[&str]) {
    let (status, stderr) = run;
    assert_eq!(status, Some(2), "{stderr}");
    assert!(stderr.contains("x.toml:3:46") && !stderr.contains("panicked"), "{stderr}");
    words.iter().for_each(|word| assert!(stderr.contains(word), "`{word}` is missing: {stderr}"));
}

const OUTSIDE: [&str; 2] = ["outside of the project's folder", "--allow-outside"];

#[test]
fn the_project_is_what_holds_experiments() {
    let home = home();
    let file = "experiments/x.toml";
    taken(plan(&home, "project", file, "../references/in.exr", &[]));
    taken(plan(&home, "project", file, "in.exr", &[]));
    taken(plan(&home, "project", file, "../references/../experiments/./in.exr", &[]));
    // however one comes to the file
    taken(plan(&home, "project/experiments", "x.toml", "../references/in.exr", &[]));
    taken(plan(&home, "elsewhere", "../project/experiments/x.toml", "../references/in.exr", &[]));
    refused(plan(&home, "project", file, "../../out.exr", &[]), &OUTSIDE);
    refused(plan(&home, "project", file, "../references/../../elsewhere/out.exr", &[]), &OUTSIDE);
}

#[test]
fn a_file_elsewhere_has_its_own_folder() {
    let home = home();
    taken(plan(&home, "project/references", "x.toml", "in.exr", &[]));
    taken(plan(&home, "elsewhere", "../project/x.toml", "references/in.exr", &[]));
    refused(plan(&home, "project/references", "x.toml", "../experiments/in.exr", &[]), &OUTSIDE);
    refused(plan(&home, "elsewhere", "x.toml", "../out.exr", &[]), &OUTSIDE);
}

#[test]
fn absolute_paths_are_outside() {
    let home = home();
    let inside = home.path().join("project/references/in.exr");
    let inside = inside.to_str().unwrap();
    let words = ["is an absolute path", "--allow-outside"];
    refused(plan(&home, "project", "experiments/x.toml", inside, &[]), &words);
    taken(plan(&home, "project", "experiments/x.toml", inside, &["--allow-outside"]));
    refused(plan(&home, "project", "experiments/x.toml", "/dev/zero", &[]), &words);
}

#[test]
fn the_user_may_allow_it() {
    let home = home();
    taken(plan(&home, "project", "experiments/x.toml", "../../out.exr", &["--allow-outside"]));
    // what is not there is not there in any case
    let missing = ["cannot read", "none.exr"];
    refused(plan(&home, "project", "experiments/x.toml", "../../none.exr", &["--allow-outside"]), &missing);
    refused(plan(&home, "project", "experiments/x.toml", "none.exr", &[]), &missing);
}

#[cfg(unix)]
#[test]
fn links_are_followed_before_one_looks() {
    use std::os::unix::fs::symlink;
    let home = home();
    let project = home.path().join("project");
    symlink(home.path().join("elsewhere"), project.join("references/away")).unwrap();
    symlink(home.path().join("out.exr"), project.join("references/link.exr")).unwrap();
    symlink(project.join("references/in.exr"), project.join("experiments/near.exr")).unwrap();
    refused(plan(&home, "project", "experiments/x.toml", "../references/away/out.exr", &[]), &OUTSIDE);
    refused(plan(&home, "project", "experiments/x.toml", "../references/link.exr", &[]), &OUTSIDE);
    taken(plan(&home, "project", "experiments/x.toml", "near.exr", &[]));
    // a project that is itself reached by a link
    symlink(&project, home.path().join("elsewhere/linked")).unwrap();
    taken(plan(&home, "elsewhere/linked", "experiments/x.toml", "../references/in.exr", &[]));
}

#[cfg(unix)]
#[test]
fn what_is_no_file_is_not_read() {
    let home = home();
    let pipe = home.path().join("project/references/pipe.exr");
    nix::unistd::mkfifo(&pipe, nix::sys::stat::Mode::S_IRWXU).unwrap();
    let no_file = |file: &str, what: &str, options: &[&str]| {
        refused(plan(&home, "project", "experiments/x.toml", file, options), &[what, "and no file"]);
    };
    no_file("../references/pipe.exr", "a device, a pipe or a socket", &[]);
    no_file("../references", "a folder", &[]);
    no_file("/dev/zero", "a device, a pipe or a socket", &["--allow-outside"]);
    // nor is an experiment file
    let mut command = Command::new(cargo_bin!("experiment"));
    fs::rename(&pipe, home.path().join("pipe.toml")).unwrap();
    let output =
        command.args(["plan", "pipe.toml"]).current_dir(home.path()).timeout(Duration::from_secs(30));
    let output = output.output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    let stderr = String::from_utf8(output.stderr).unwrap();
    assert!(stderr.contains("cannot read pipe.toml: it is a device, a pipe or a socket"), "{stderr}");
}
