//! Files that are no library of a model that this engine can run: each is refused, and says why.

#![cfg(target_os = "linux")]

use dalembert::kernel::{CONTRACT_VERSION, ContractError};
use dalembert::model::Model;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The constant that a model exports, but for what is changed: nothing in it is looked at before its head is right.
const HEAD: &str = "
typedef double real;
#include \"contract.h\"
const struct dalembert_model dalembert_model = {
  .mark = DALEMBERT_CONTRACT_MARK, .version = DALEMBERT_CONTRACT_VERSION,
  .size = sizeof(struct dalembert_model), .digest = \"0123\", .name = \"own\",
  .description_length = 2, .description = \"{}\",
};
";

/// Compiles a text to a library.
fn library(folder: &Path, text: &str) -> PathBuf {
    let (source, library) = (folder.join("own.c"), folder.join("libown.so"));
    fs::write(&source, text).unwrap();
    let header = concat!(env!("CARGO_MANIFEST_DIR"), "/codegen");
    let status = Command::new("cc")
        .args(["-shared", "-fPIC", "-I", header, "-o"])
        .args([&library, &source])
        .status();
    assert!(status.unwrap().success());
    library
}

fn refused(file: &Path) -> ContractError {
    Model::load(file, Some("0123")).expect_err("it is no model")
}

/// What the system or the header says of a file that is no library.
fn told(file: &Path) -> String {
    match refused(file) {
        ContractError::Library { message } => message,
        ContractError::File(fault) => fault.to_string(),
        other => panic!("{other}"),
    }
}

#[test]
fn what_differs_in_the_head_of_a_library_is_told_with_both_values() {
    let folder = tempfile::tempdir().unwrap();
    let changed =
        |from: &str, to: &str| refused(&library(folder.path(), &HEAD.replacen(from, to, 1)));
    let error = changed("= DALEMBERT_CONTRACT_MARK", "= \"somebody\"");
    assert!(
        matches!(&error, ContractError::Mark { found, .. } if found == "somebody"),
        "{error}"
    );
    let error = changed("= DALEMBERT_CONTRACT_VERSION", "= 99");
    let (found, expected) = (99, CONTRACT_VERSION);
    assert_eq!(error, ContractError::Version { found, expected });
    let error = changed("= sizeof(struct dalembert_model)", "= 12");
    assert!(
        matches!(error, ContractError::Size { found: 12, .. }),
        "{error}"
    );
    let error = changed("\"0123\"", "\"4567\"");
    let (found, expected) = ("4567".to_owned(), "0123".to_owned());
    assert_eq!(error, ContractError::Digest { found, expected });
    // With the right head it is the description that is no model's.
    let error = changed("{}", "{}");
    assert!(
        matches!(&error, ContractError::Description { .. }),
        "{error}"
    );
}

#[test]
fn a_file_that_cannot_be_loaded_is_told_from_another() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("file.so");
    assert!(told(&file).contains("No such file"));
    for text in ["", "no library", &"no library ".repeat(100)] {
        fs::write(&file, text).unwrap();
        assert_eq!(told(&file), "it is no shared library");
    }
    assert!(told(&library(folder.path(), "int somebody;")).contains("dalembert_model"));

    let whole = fs::read(library(folder.path(), HEAD)).unwrap();
    // Everywhere behind its header: the loader would read beyond its end.
    for length in (64..whole.len()).step_by(997) {
        fs::write(&file, &whole[..length]).unwrap();
        let expected = format!("it is cut off: it has {length} of {} bytes", whole.len());
        assert_eq!(told(&file), expected);
    }
    // As for 32 bits, and for other processors (243: RISC-V).
    for (at, byte) in [(4, 1), (18, 243)] {
        let mut other = whole.clone();
        other[at] = byte;
        fs::write(&file, other).unwrap();
        let message = told(&file);
        assert!(
            message.contains("it is for another processor: its header has the machine"),
            "{message}"
        );
    }
}
