//! No input makes the reader panic, and every error has a place in its file.

use proptest::prelude::*;

use super::*;

/// One change of some bytes.
#[derive(Debug, Clone)]
enum Change {
    Delete(usize, usize),
    Duplicate(usize, usize),
    Overwrite(usize, u8),
    Insert(usize, String),
}

fn change() -> impl Strategy<Value = Change> {
    let place = any::<usize>();
    let length = 1..40_usize;
    // Pieces that keep the text JSON more often than bytes do.
    let piece = prop::sample::select(vec![
        "{}",
        "[]",
        "null",
        "true",
        "-1",
        "0",
        "1e999",
        "\"\"",
        "\"7 kg\"",
        ",",
        ":",
        "\"",
        "\\u12",
        "\\",
        "\u{feff}",
        "é",
        "\n",
        "\"end\": -1,",
        "\"x\"",
        "[[",
        "]]",
        "0.0",
        "//",
        "\u{0}",
        "\u{a0}",
        "\u{b}",
    ]);
    prop_oneof![
        (place, length.clone()).prop_map(|(at, n)| Change::Delete(at, n)),
        (place, length).prop_map(|(at, n)| Change::Duplicate(at, n)),
        (place, any::<u8>()).prop_map(|(at, byte)| Change::Overwrite(at, byte)),
        (place, piece).prop_map(|(at, piece)| Change::Insert(at, piece.to_owned())),
    ]
}

fn apply(text: &mut Vec<u8>, change: &Change) {
    let index = |at: usize| at % text.len().max(1);
    let range = |at: usize, n: usize| index(at)..(index(at) + n).min(text.len());
    match change {
        Change::Delete(at, n) => drop(text.drain(range(*at, *n))),
        Change::Duplicate(at, n) => {
            let range = range(*at, *n);
            let copy = text[range.clone()].to_vec();
            text.splice(range.end..range.end, copy);
        }
        Change::Overwrite(at, byte) => {
            let index = index(*at);
            if let Some(place) = text.get_mut(index) {
                *place = *byte;
            }
        }
        Change::Insert(at, piece) => {
            let index = index(*at).min(text.len());
            text.splice(index..index, piece.bytes());
        }
    }
}

/// Whether every error points to an existing place and can be shown.
fn check(result: Result<Scene, SceneErrors>, scene: &[u8], table: &[u8]) {
    let Err(errors) = result else { return };
    assert!(errors.iter().count() > 0);
    for error in &errors {
        let position = error
            .position()
            .expect("only an unreadable scene has no place");
        let text = match position.file.as_str() {
            "scenes/test.json" => String::from_utf8_lossy(scene),
            "scenes/record.csv" => String::from_utf8_lossy(table),
            other => panic!("unknown file {other}"),
        };
        assert!(position.bytes.end <= text.len());
        let line = text
            .split('\n')
            .nth(position.line - 1)
            .expect("a line of the file");
        assert!(position.column <= line.chars().count() + 1);
        let shown = error.to_string();
        assert!(
            shown.contains('^') && shown.contains(&position.file),
            "{shown}"
        );
        let place = format!("{}:{}:{}", position.file, position.line, position.column);
        assert!(shown.contains(&place), "{place} is not in\n{shown}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    #[test]
    fn changed_scenes_are_read_or_refused(changes in prop::collection::vec(change(), 1..4)) {
        let mut scene = FULL.as_bytes().to_vec();
        changes.iter().for_each(|c| apply(&mut scene, c));
        check(parse_with(&scene, &[], &[("record.csv", RECORD.as_bytes())]), &scene, RECORD.as_bytes());
    }

    #[test]
    fn changed_tables_are_read_or_refused(changes in prop::collection::vec(change(), 1..4)) {
        let mut table = RECORD.as_bytes().to_vec();
        changes.iter().for_each(|c| apply(&mut table, c));
        check(parse_with(FULL.as_bytes(), &[], &[("record.csv", &table)]), FULL.as_bytes(), &table);
    }

    #[test]
    fn any_override_is_applied_or_refused(
        path in "(parameters|initial|inputs|end|freeze|accuracy)?(\\.[a-z_0-9]{0,6}){0,3}",
        value in "(\\PC{0,8}|-?[0-9.e]{1,6}|\\[\\]|\\{\\}|null)",
    ) {
        let argument = format!("{path}={value}");
        let tables: &[(&str, &[u8])] = &[("record.csv", RECORD.as_bytes())];
        if let Err(errors) = parse_with(FULL.as_bytes(), &[&argument], tables) {
            prop_assert!(errors.iter().all(|e| e.position().is_some()));
            prop_assert!(!errors.to_string().is_empty());
        }
    }
}

#[test]
fn deep_nesting_is_refused() {
    let text = "[".repeat(100_000);
    only_error(parse(&text));
    let text = format!("{{\"model\": {}1{}}}", "[".repeat(400), "]".repeat(400));
    only_error(parse(&text));
}
