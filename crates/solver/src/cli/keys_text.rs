//! The reference of keys as text for a terminal: a key and its type, its default and limits, its
//! meaning, each on lines of their own.

/// Columns of a line.
const COLUMNS: usize = 100;

/// The text of a page, or of sections of one, in the Markdown of [`dem_scene::reference`].
pub(super) fn plain(page: &str) -> String {
    let mut text = String::new();
    for line in page.lines() {
        if line.starts_with("|---") || line.starts_with("| key |") || line.starts_with("| |") {
            continue;
        }
        if let Some(heading) = line.strip_prefix("## ").or(line.strip_prefix("# ")) {
            text += &format!("{}\n", words(heading));
        } else if let Some(row) = line.strip_prefix("| ") {
            text += &entry(row);
        } else {
            // How the page is made is of no use on a terminal.
            let line = line.split_once(" is read. ").map_or(line, |(_, rest)| rest);
            text += &wrapped(&words(line), 0);
        }
    }
    text
}

/// The row of a key, or of the units of a quantity.
fn entry(row: &str) -> String {
    let row = row.trim_end_matches(" |").replace("\\|", "\u{0}");
    // A row in which a cell is empty has one blank there.
    let cells: Vec<String> = row
        .replace(" | | ", " |  | ")
        .replace(" | | ", " |  | ")
        .split(" | ")
        .map(|cell| words(&cell.replace('\u{0}', "|")))
        .collect();
    match cells.as_slice() {
        [key, kind, unit, usual, limits, meaning] => {
            let unit = parenthesised(unit);
            let usual = match usual.as_str() {
                "required" => "required".to_owned(),
                usual => format!("default {usual}"),
            };
            let limits = match limits.as_str() {
                "" => String::new(),
                limits => format!("; {limits}"),
            };
            wrapped(&format!("{key}: {kind}{unit}; {usual}{limits}"), 2) + &wrapped(meaning, 6)
        }
        [quantity, si, units] => wrapped(&format!("{quantity}{}: {units}", parenthesised(si)), 2),
        others => wrapped(&others.join(", "), 2),
    }
}

fn parenthesised(unit: &str) -> String {
    match unit {
        "" => String::new(),
        unit => format!(" ({unit})"),
    }
}

/// Markdown without links, quotes of code and escapes.
fn words(markdown: &str) -> String {
    let mut text = markdown.replace('`', "");
    while let Some(end) = text.find("](#") {
        let Some(length) = text[end..].find(')') else {
            break;
        };
        let Some(start) = opening(&text[..end]) else {
            break;
        };
        let inner = text[start + 1..end].to_owned();
        text.replace_range(start..=end + length, &inner);
    }
    text.replace("\\[", "[").replace("\\]", "]")
}

/// Where the bracket stands that a `]` after this text closes.
fn opening(text: &str) -> Option<usize> {
    let mut depth = 1;
    for (at, letter) in text.char_indices().rev() {
        match letter {
            ']' => depth += 1,
            '[' => depth -= 1,
            _ => {}
        }
        if depth == 0 {
            return Some(at);
        }
    }
    None
}

/// A paragraph on lines of at most [`COLUMNS`], each with this indent.
fn wrapped(paragraph: &str, indent: usize) -> String {
    let blank = " ".repeat(indent);
    let mut text = String::new();
    let mut line = String::new();
    for word in paragraph.split_whitespace() {
        let width = line.chars().count() + word.chars().count();
        if !line.is_empty() && indent + width >= COLUMNS {
            text += &format!("{blank}{line}\n");
            line.clear();
        }
        if !line.is_empty() {
            line.push(' ');
        }
        line += word;
    }
    text + &format!("{}\n", format!("{blank}{line}").trim_end())
}
