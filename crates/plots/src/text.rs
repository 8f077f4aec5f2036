//! Text in plots, and its width. The fonts of the viewer are unknown, so the width is an estimate
//! on the wide side.

/// `text` with control characters made visible and without characters that XML does not allow.
pub(crate) fn shown(text: &str) -> String {
    dem_io::text::visible(text).replace(['\u{fffe}', '\u{ffff}'], "")
}

/// Width of `text`, px.
pub(crate) fn width(text: &str, font_size: f64) -> f64 {
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

/// `text` as [`shown`], or as much of its beginning as fits, with an ellipsis.
pub(crate) fn shortened(text: &str, font_size: f64, limit: f64) -> String {
    let text = shown(text);
    if width(&text, font_size) <= limit {
        return text;
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
