//! Numbers as text; text from outside on a terminal or a page. File names and texts of scenes may
//! contain anything: nothing in them may move a cursor, start a line, change the direction of
//! writing or open a tag.

use std::borrow::Cow;

/// True if a terminal would obey this character instead of showing it: control characters, line
/// separators, and characters that change the direction of writing.
fn is_obeyed(letter: char) -> bool {
    let turns_or_separates = matches!(
        letter,
        '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}'
    );
    letter.is_control() || turns_or_separates
}

/// `text` on one line, with each character that controls a terminal as `\u{1b}`.
pub fn visible(text: &str) -> Cow<'_, str> {
    escape(text, is_obeyed)
}

/// As [`visible`], for several lines, which stay lines, with tabs in them.
pub fn visible_lines(text: &str) -> Cow<'_, str> {
    escape(text, |letter| {
        !matches!(letter, '\n' | '\t') && is_obeyed(letter)
    })
}

/// The number as tables show it: the shortest text that reads back as the same number, with an
/// exponent if it is tiny or huge.
pub fn exact(value: f64) -> String {
    if value == 0.0 || (1e-4..1e7).contains(&value.abs()) {
        format!("{value}")
    } else {
        format!("{value:e}")
    }
}

fn escape(text: &str, is_escaped: impl Fn(char) -> bool) -> Cow<'_, str> {
    if !text.chars().any(&is_escaped) {
        return Cow::Borrowed(text);
    }
    let mut shown = String::with_capacity(text.len() + 16);
    for letter in text.chars() {
        if is_escaped(letter) {
            shown.extend(letter.escape_unicode());
        } else {
            shown.push(letter);
        }
    }
    Cow::Owned(shown)
}

/// A number of things: "1 bond", "2 bonds".
pub fn counted(count: usize, what: &str) -> String {
    let s = if count == 1 { "" } else { "s" };
    format!("{count} {what}{s}")
}

/// JSON with the characters that control a terminal as `\u001b`, which has the same meaning.
pub(crate) fn visible_json(json: &str) -> Cow<'_, str> {
    let is_escaped = |letter: char| letter != '\n' && is_obeyed(letter);
    if !json.chars().any(is_escaped) {
        return Cow::Borrowed(json);
    }
    let mut shown = String::with_capacity(json.len() + 16);
    for letter in json.chars() {
        if is_escaped(letter) {
            // All of them are below U+FFFF.
            shown += &format!("\\u{:04x}", u32::from(letter));
        } else {
            shown.push(letter);
        }
    }
    Cow::Owned(shown)
}

#[cfg(test)]
mod tests {
    use super::*;

    const NASTY: &str = "a\u{1b}[31m\n\u{9b}\u{202e}\u{2066}\u{7f}<script>\"&é";

    #[test]
    fn what_a_terminal_would_obey_is_shown() {
        assert!(matches!(visible("a.toml, 5 µm"), Cow::Borrowed(_)));
        assert_eq!(
            visible(NASTY),
            "a\\u{1b}[31m\\u{a}\\u{9b}\\u{202e}\\u{2066}\\u{7f}<script>\"&é"
        );
        assert_eq!(visible(&visible(NASTY)), visible(NASTY));
        assert_eq!(visible_lines("a\n\tb\r"), "a\n\tb\\u{d}");
    }

    #[test]
    fn json_means_the_same() {
        let json = serde_json::to_string(NASTY).unwrap_or_default();
        let shown = visible_json(&json);
        assert!(!shown.chars().any(is_obeyed), "{shown}");
        assert_eq!(
            serde_json::from_str::<String>(&shown).ok().as_deref(),
            Some(NASTY)
        );
    }
}
