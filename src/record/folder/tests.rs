use super::*;

fn folder(path: &Path, files: &[(&str, &str)]) -> Result<(), FolderError> {
    OutputFolder::new(path)?.replace(|staging| {
        files
            .iter()
            .try_for_each(|(name, text)| staging.file(name, |out| out.write_all(text.as_bytes())))
    })
}

fn names(path: &Path) -> Vec<String> {
    let name = |e: io::Result<fs::DirEntry>| e.unwrap().file_name().into_string().unwrap();
    let mut names: Vec<_> = fs::read_dir(path).unwrap().map(name).collect();
    names.sort();
    names
}

#[test]
fn a_second_run_replaces_the_first_and_keeps_foreign_files() {
    let home = tempfile::tempdir().unwrap();
    let out = home.path().join("above").join("out");
    folder(&out, &[("a.csv", "1"), ("b.csv", "1")]).unwrap();
    fs::create_dir_all(out.join("notes/deep")).unwrap();
    fs::write(out.join("notes/deep/own.txt"), "mine").unwrap();
    fs::write(out.join("own.txt"), "mine").unwrap();
    folder(&out, &[("a.csv", "2")]).unwrap();
    assert_eq!(names(&out), [DIGESTS, MARKER, "a.csv", "notes", "own.txt"]);
    assert_eq!(fs::read_to_string(out.join("a.csv")).unwrap(), "2");
    assert_eq!(fs::read_to_string(out.join("own.txt")).unwrap(), "mine");
    assert_eq!(
        fs::read_to_string(out.join("notes/deep/own.txt")).unwrap(),
        "mine"
    );
    assert_eq!(
        names(out.parent().unwrap()),
        ["out"],
        "nothing is left beside the folder"
    );
}

#[test]
fn what_killed_runs_have_left_is_removed_and_nothing_else() {
    let home = tempfile::tempdir().unwrap();
    let at = |name: &str| home.path().join(name);
    for name in [
        ".out.aB3dE6",
        ".out.old123",
        ".out.living",
        ".out.mine",
        ".other.aB3dE6",
    ] {
        fs::create_dir(at(name)).unwrap();
    }
    for name in [".out.aB3dE6", ".other.aB3dE6"] {
        drop(lock(&at(name)).unwrap());
    }
    fs::write(at(".out.old123").join(MARKER), "").unwrap();
    let living = lock(&at(".out.living")).unwrap();
    folder(&at("out"), &[("a.csv", "1")]).unwrap();
    assert_eq!(
        names(home.path()),
        [".other.aB3dE6", ".out.living", ".out.mine", "out"]
    );
    drop(living);
    folder(&at("out"), &[("a.csv", "1")]).unwrap();
    assert_eq!(names(home.path()), [".other.aB3dE6", ".out.mine", "out"]);
    assert_eq!(names(&at("out")), [DIGESTS, MARKER, "a.csv"]);
}

#[test]
fn a_foreign_folder_is_refused_and_stays() {
    let home = tempfile::tempdir().unwrap();
    fs::write(home.path().join("thesis.tex"), "years of work").unwrap();
    let error = folder(home.path(), &[("a.csv", "1")]).unwrap_err();
    assert!(matches!(&error, FolderError::NotOurs { entry, .. } if entry == "thesis.tex"));
    assert_eq!(names(home.path()), ["thesis.tex"]);
}

#[test]
fn a_foreign_file_with_a_name_we_need_is_refused_and_stays() {
    let home = tempfile::tempdir().unwrap();
    let out = home.path().join("out");
    folder(&out, &[("a.csv", "1")]).unwrap();
    fs::write(out.join("b.csv"), "mine").unwrap();
    let error = folder(&out, &[("a.csv", "2"), ("b.csv", "2")]).unwrap_err();
    assert!(matches!(&error, FolderError::WouldReplace { file, .. } if file == "b.csv"));
    assert_eq!(fs::read_to_string(out.join("a.csv")).unwrap(), "1");
    assert_eq!(fs::read_to_string(out.join("b.csv")).unwrap(), "mine");
    assert_eq!(names(home.path()), ["out"]);
}

#[test]
fn a_failure_while_writing_leaves_the_old_files() {
    let home = tempfile::tempdir().unwrap();
    let out = home.path().join("out");
    folder(&out, &[("a.csv", "1")]).unwrap();
    let failed = OutputFolder::new(&out).unwrap().replace(|staging| {
        staging.file("a.csv", |out| out.write_all(b"2"))?;
        staging.file("b.csv", |_| Err(io::Error::other("disk full")))
    });
    assert!(failed.unwrap_err().to_string().contains("disk full"));
    assert_eq!(fs::read_to_string(out.join("a.csv")).unwrap(), "1");
    assert_eq!(names(home.path()), ["out"]);
}

#[test]
fn an_empty_folder_is_taken_and_a_file_or_the_current_folder_is_not() {
    let home = tempfile::tempdir().unwrap();
    folder(home.path(), &[("a.csv", "1")]).unwrap();
    let file = home.path().join("a.csv");
    assert!(matches!(
        OutputFolder::new(&file),
        Err(FolderError::NotAFolder { .. })
    ));
    assert!(matches!(
        OutputFolder::new(Path::new(".")),
        Err(FolderError::HoldsCurrent { .. })
    ));
}

#[test]
fn the_exchange_in_steps_does_the_same() {
    let home = tempfile::tempdir().unwrap();
    let (a, b) = (home.path().join("a"), home.path().join("b"));
    for path in [&a, &b] {
        fs::create_dir(path).unwrap();
        fs::write(path.join(path.file_name().unwrap()), "").unwrap();
    }
    exchange_in_steps(&a, &b).unwrap();
    assert_eq!(
        (names(&a), names(&b)),
        (vec!["b".to_owned()], vec!["a".to_owned()])
    );
}

#[cfg(unix)]
#[test]
fn a_linked_folder_stays_linked_and_permissions_stay() {
    use std::os::unix::fs::{PermissionsExt, symlink};
    let home = tempfile::tempdir().unwrap();
    let (real, link) = (home.path().join("real"), home.path().join("link"));
    folder(&real, &[("a.csv", "1")]).unwrap();
    fs::set_permissions(&real, fs::Permissions::from_mode(0o750)).unwrap();
    symlink(&real, &link).unwrap();
    folder(&link, &[("a.csv", "2")]).unwrap();
    assert_eq!(fs::read_to_string(real.join("a.csv")).unwrap(), "2");
    assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
    assert_eq!(
        fs::metadata(&real).unwrap().permissions().mode() & 0o777,
        0o750
    );
}
