//! Expected messages: one file `messages.txt` per folder, one line per message.

use std::path::Path;

/// Compares the messages of the cases of a folder, in order, with its file `messages.txt`; with
/// `RENEW_MESSAGES` set, rewrites the file first.
///
/// # Panics
/// They differ.
pub fn hold_messages(folder: &Path, found: &[String]) {
    let path = folder.join("messages.txt");
    if std::env::var_os("RENEW_MESSAGES").is_some() {
        std::fs::write(&path, found.join("\n") + "\n").unwrap();
    }
    let text = std::fs::read_to_string(&path).unwrap();
    let expected: Vec<String> = text.lines().map(str::to_owned).collect();
    if found == expected {
        return;
    }
    let only = |here: &[String], there: &[String], sign: &str| -> String {
        let lines = here.iter().filter(|line| !there.contains(line));
        lines.map(|line| format!("{sign} {line}\n")).collect()
    };
    panic!(
        "not the messages of {} (after a look at them, RENEW_MESSAGES=1 writes it anew):\n{}{}",
        path.display(),
        only(&expected, found, "expected"),
        only(found, &expected, "got     "),
    );
}
