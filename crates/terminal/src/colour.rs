//! Colours of words on a terminal. `NO_COLOR` turns them off, `CLICOLOR_FORCE=1` on in pipes and
//! files too.

use std::io;

use anstream::stream::RawStream;
use anstream::{AutoStream, ColorChoice};
use anstyle::{AnsiColor, Style};

/// The colour of a word.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Colour {
    /// Of errors.
    Red,
    /// Of warnings.
    Yellow,
    /// Of success.
    Green,
}

impl Colour {
    fn style(self) -> Style {
        let colour = match self {
            Self::Red => AnsiColor::Red,
            Self::Yellow => AnsiColor::Yellow,
            Self::Green => AnsiColor::Green,
        };
        colour.on_default().bold()
    }
}

/// A text for standard error, in this colour where that is shown.
pub fn on_standard_error(text: &str, colour: Colour) -> String {
    painted(text, colour, &io::stderr())
}

/// A text for standard output, in this colour where that is shown.
pub fn on_standard_output(text: &str, colour: Colour) -> String {
    painted(text, colour, &io::stdout())
}

fn painted(text: &str, colour: Colour, stream: &impl RawStream) -> String {
    match AutoStream::choice(stream) {
        ColorChoice::Never => text.to_owned(),
        _ => {
            let style = colour.style();
            format!("{style}{text}{style:#}")
        }
    }
}
