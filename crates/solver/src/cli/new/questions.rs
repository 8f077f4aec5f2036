//! Answers from options, or from a person at a terminal, who is asked for those that are missing.

use std::io::{BufRead, Write};

use dem_io::{Diagnostic, Result};

/// What is asked.
#[derive(Debug)]
pub(super) struct Question<'a> {
    /// The option with the same answer, such as `--height`.
    pub(super) option: &'a str,
    /// What it is, after its name.
    pub(super) what: &'a str,
    /// What an empty answer means, in words.
    pub(super) default: String,
}

/// The terminal of a person; None if nothing is asked.
#[derive(Debug)]
pub(super) struct Questions<R, W> {
    pub(super) terminal: Option<(R, W)>,
}

impl<R: BufRead, W: Write> Questions<R, W> {
    /// The answer that was given as an option, or else the one of the person, read by `read`. A
    /// wrong one is asked again. None: the default.
    pub(super) fn answer<T>(
        &mut self,
        question: &Question,
        given: Option<&str>,
        read: impl Fn(&str) -> Result<T>,
    ) -> Result<Option<T>> {
        let read = |text: &str| read(text).map_err(|error| error.within(question.option));
        if let Some(text) = given {
            return read(text).map(Some);
        }
        let Some((input, output)) = &mut self.terminal else {
            return Ok(None);
        };
        let name = question.option.trim_start_matches('-');
        loop {
            let asked = write!(output, "{name}, {} [{}]: ", question.what, question.default);
            // Who cannot see the question does not answer it.
            let _ = asked.and_then(|()| output.flush());
            let mut line = String::new();
            match input.read_line(&mut line) {
                Ok(0) => return Err(ended(question)),
                Err(error) => {
                    let problem = format!("the answer cannot be read: {error}");
                    return Err(Diagnostic::input(
                        question.option,
                        problem,
                        "give the option",
                    ));
                }
                Ok(_) if line.trim().is_empty() => return Ok(None),
                Ok(_) => match read(line.trim()) {
                    Ok(answer) => return Ok(Some(answer)),
                    Err(error) => {
                        let _ = writeln!(output, "{error}");
                    }
                },
            }
        }
    }
}

fn ended(question: &Question) -> Diagnostic {
    Diagnostic::input(
        question.option,
        "the input ended where an answer was expected; one line is needed, which may be empty",
        format!(
            "press Enter for {}, give {} or --yes",
            question.default, question.option
        ),
    )
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use dem_io::units::length_m;

    const HEIGHT: &str = "--height";

    /// The answer to one question of a person who types this, and what the person sees.
    fn asked(typed: &str, given: Option<&str>) -> (Result<Option<f64>>, String) {
        let mut seen = Vec::new();
        let mut questions = Questions {
            terminal: Some((typed.as_bytes(), &mut seen)),
        };
        let question = Question {
            option: HEIGHT,
            what: "of the fall",
            default: "1 m".to_owned(),
        };
        let answer = questions.answer(&question, given, length_m);
        (answer, String::from_utf8(seen).unwrap())
    }

    #[test]
    fn enter_takes_the_default() {
        let prompt = "height, of the fall [1 m]: ";
        assert_eq!(asked("\n", None), (Ok(None), prompt.to_owned()));
        assert_eq!(asked(" 20 mm \r\n", None), (Ok(Some(0.02)), prompt.into()));
        assert_eq!(asked("20 mm", None).0, Ok(Some(0.02)));
    }

    #[test]
    fn a_wrong_answer_is_asked_again_with_the_message_of_the_option() {
        let (answer, seen) = asked("high\n2 m\n", None);
        assert_eq!(answer, Ok(Some(2.0)));
        let message = asked("", Some("high")).0.unwrap_err().to_string();
        assert!(message.starts_with("--height: 'high' is not a length"));
        let prompt = "height, of the fall [1 m]: ";
        assert_eq!(seen, format!("{prompt}{message}\n{prompt}"));
    }

    #[test]
    fn a_closed_input_is_refused() {
        for typed in ["", "high\n"] {
            let refused = asked(typed, None).0.unwrap_err();
            assert_eq!(refused.exit_code(), 2);
            let said = refused.to_string();
            assert!(said.starts_with("--height: the input ended"), "{said}");
            assert!(said.contains("press Enter for 1 m"), "{said}");
        }
        assert_eq!(asked("", Some("3 m")), (Ok(Some(3.0)), String::new()));
    }

    #[test]
    fn without_a_terminal_nothing_is_asked() {
        let mut questions = Questions::<&[u8], Vec<u8>> { terminal: None };
        let question = Question {
            option: HEIGHT,
            what: "",
            default: String::new(),
        };
        assert_eq!(questions.answer(&question, None, length_m), Ok(None));
    }
}
