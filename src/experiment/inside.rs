//! Files that an experiment file names: they lie in the folder of its project, unless the user says otherwise. Who runs a
//! file that someone else has written does not want it to look around.

use std::path::{Path, PathBuf};

/// Where the file lies that `file`, an experiment file, calls `named`: relative to its own folder, and inside the folder of
/// its project, which holds `experiments/`; a file elsewhere has its own folder only.
///
/// # Errors
///
/// When it is not there; unless `outside` is allowed, also when it leads elsewhere, be it by `..` or by a link.
pub fn resolve(file: &Path, named: &Path, outside: bool) -> Result<PathBuf, String> {
    let folder = file.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let path = folder.join(named);
    if outside {
        return Ok(path);
    }
    let right = "name a file inside it, relative to the experiment file, or add --allow-outside";
    let unreadable = |e: std::io::Error| format!("cannot read {}: {e}", path.display());
    let mut project = folder.canonicalize().map_err(unreadable)?;
    if project.file_name().is_some_and(|name| name == "experiments") {
        project.pop();
    }
    if named.is_absolute() || named.has_root() {
        let (named, project) = (named.display(), project.display());
        return Err(format!(
            "{named} is an absolute path, and files are read from the project's folder {project} only; {right}"
        ));
    }
    let found = path.canonicalize().map_err(unreadable)?;
    if found.starts_with(&project) {
        return Ok(path);
    }
    Err(format!(
        "{} is {}, which is outside of the project's folder {}; {right}",
        path.display(),
        found.display(),
        project.display()
    ))
}
