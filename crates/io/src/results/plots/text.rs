//! How wide text is. The fonts of the viewer are not known, so this is an estimate on the wide side.

/// Width of `text`, px.
pub(super) fn width(text: &str, font_size: f64) -> f64 {
    text.chars()
        .map(|letter| match letter {
            'i' | 'j' | 'l' | '.' | ',' | ':' | ';' | '|' | '\'' | 'I' | '(' | ')' | ' ' | 't'
            | 'f' | 'r' => 0.4,
            'm' | 'w' | 'M' | 'W' | '@' | '%' => 0.9,
            '⁰'..='₎' | '¹' | '²' | '³' => 0.4,
            letter if letter.is_ascii_uppercase() => 0.7,
            // Chinese, Japanese, Korean and pictures.
            '\u{1100}'.. => 1.05,
            _ => 0.6,
        })
        .sum::<f64>()
        * font_size
}

/// `text`, or as much of its beginning as fits, with an ellipsis.
pub(super) fn shortened(text: &str, font_size: f64, limit: f64) -> String {
    if width(text, font_size) <= limit {
        return text.to_owned();
    }
    let mut end = String::new();
    for letter in text.chars() {
        end.push(letter);
        if width(&end, font_size) + font_size > limit {
            end.pop();
            break;
        }
    }
    end.push('…');
    end
}
