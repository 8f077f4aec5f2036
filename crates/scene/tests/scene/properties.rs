//! For any text, the reader returns a scene or one message.

use dem_scene::scene_from_text;
use proptest::prelude::*;

const EVERY_KEY: &str = include_str!("good/every-key.toml");
const CLUMPS_AND_FEED: &str = include_str!("good/clumps-and-feed.toml");

/// A change of a text.
#[derive(Debug, Clone)]
enum Change {
    /// Bytes are cut out.
    Cut(usize, usize),
    /// Text is put in.
    Put(usize, String),
    /// A part is repeated elsewhere.
    Copy(usize, usize, usize),
    /// One word becomes another of the same text.
    Word(usize, usize),
}

/// A change of a text of `bytes`.
fn change(bytes: usize) -> impl Strategy<Value = Change> {
    let place = 0..bytes;
    let length = 1..60_usize;
    prop_oneof![
        (place.clone(), length.clone()).prop_map(|(at, length)| Change::Cut(at, length)),
        (
            place.clone(),
            prop_oneof![
                "\\PC{0,8}",
                "[-+0-9.eE_]{1,12}",
                "[\\[\\]{}=\",.\n#']{1,4}",
                Just("nan".to_owned()),
                Just("-1".to_owned()),
                Just("1e999".to_owned()),
                Just("[]".to_owned()),
                Just("0xffffffffffffffffff".to_owned()),
                Just("1979-05-27".to_owned()),
            ]
        )
            .prop_map(|(at, text)| Change::Put(at, text)),
        (place.clone(), length, place.clone())
            .prop_map(|(from, length, to)| Change::Copy(from, length, to)),
        (place.clone(), place).prop_map(|(from, to)| Change::Word(from, to)),
    ]
}

/// The nearest place before `at` where a character begins.
fn boundary(text: &str, at: usize) -> usize {
    let mut at = at.min(text.len());
    while !text.is_char_boundary(at) {
        at -= 1;
    }
    at
}

fn word(text: &str, at: usize) -> (usize, usize) {
    let inside = |byte: &u8| byte.is_ascii_alphanumeric() || matches!(byte, b'_' | b'.');
    let bytes = text.as_bytes();
    let at = boundary(text, at);
    let start = at - bytes[..at].iter().rev().take_while(|b| inside(b)).count();
    let end = at + bytes[at..].iter().take_while(|b| inside(b)).count();
    (start, end)
}

fn changed(mut text: String, change: &Change) -> String {
    match change {
        Change::Cut(at, length) => {
            let (from, to) = (boundary(&text, *at), boundary(&text, at + length));
            text.replace_range(from..to, "");
        }
        Change::Put(at, new) => text.insert_str(boundary(&text, *at), new),
        Change::Copy(from, length, to) => {
            let part = text[boundary(&text, *from)..boundary(&text, from + length)].to_owned();
            text.insert_str(boundary(&text, *to), &part);
        }
        Change::Word(from, to) => {
            let (start, end) = word(&text, *from);
            let new = text[start..end].to_owned();
            let (start, end) = word(&text, *to);
            text.replace_range(start..end, &new);
        }
    }
    text
}

fn assert_one_message(text: &str, options: &[String]) {
    match scene_from_text(text, "any.toml", options) {
        Ok(scene) => assert!(scene.describe().lines().count() > 7),
        Err(error) => {
            let message = error.to_string();
            assert!(!message.contains('\n'), "{message:?}");
            assert!(
                message.starts_with("any.toml:") || message.starts_with("--set "),
                "{message}"
            );
            assert!(!error.problem.is_empty(), "{message}");
            assert!(!error.remedy.is_empty(), "no remedy: {message}");
            assert_eq!(error.exit_code(), 2);
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn changed_scenes(changes in prop::collection::vec(change(EVERY_KEY.len()), 1..5)) {
        let text = changes.iter().fold(EVERY_KEY.to_owned(), changed);
        assert_one_message(&text, &[]);
    }

    #[test]
    fn changed_feeds(changes in prop::collection::vec(change(CLUMPS_AND_FEED.len()), 1..5)) {
        let text = changes.iter().fold(CLUMPS_AND_FEED.to_owned(), changed);
        assert_one_message(&text, &[]);
    }

    #[test]
    fn any_text(text in "\\PC{0,200}") {
        assert_one_message(&text, &[]);
    }

    #[test]
    fn any_option(key in "[a-z._]{0,20}", value in "\\PC{0,40}", option in "\\PC{0,40}") {
        assert_one_message(EVERY_KEY, &[format!("{key}={value}")]);
        assert_one_message(EVERY_KEY, &[option]);
    }
}

/// Brackets nested as deeply as a file allows give a message, not a stack overflow.
#[test]
fn deep_nesting() {
    for depth in [10, 79, 80, 81, 100_000] {
        assert_one_message(&format!("version = {}", "[".repeat(depth)), &[]);
        let lists = format!("{}{}", "[".repeat(depth), "]".repeat(depth));
        assert_one_message(&format!("version = 1\nrun = {lists}"), &[]);
        assert_one_message(EVERY_KEY, &[format!("run.rest_energy_ratio={lists}")]);
        let keys = vec!["a"; depth].join(".");
        assert_one_message(&format!("version = 1\n[{keys}]\n{keys} = 1"), &[]);
        assert_one_message(EVERY_KEY, &[format!("{keys}=1")]);
    }
}
