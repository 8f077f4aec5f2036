//! An error for the user: its place, the wrong value, and the remedy.

use std::fmt;

use crate::text::visible;

/// The origin of an error, which determines the exit code of the programs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Bad input: exit code 2.
    Input,
    /// The program could not do its work (disk full): exit code 1.
    Failed,
    /// The user stopped it (Ctrl-C): exit code 130.
    Interrupted,
    /// A check stopped the run because it went unstable: exit code 3.
    Unstable,
}

/// One message: place, problem and remedy. Its debug form is the same sentence, so that a `main`
/// that returns it prints what a user can read.
#[derive(Clone, PartialEq, Eq)]
pub struct Diagnostic {
    /// Origin of the error.
    pub kind: Kind,
    /// File, line, facet or option, as precise as known. May be empty.
    pub place: String,
    /// The problem, with the value and the limit.
    pub problem: String,
    /// The remedy. May be empty.
    pub remedy: String,
}

/// Result of every function that can fail because of the user's input.
pub type Result<T> = std::result::Result<T, Diagnostic>;

impl Diagnostic {
    /// Bad input at `place`.
    pub fn input(
        place: impl Into<String>,
        problem: impl Into<String>,
        remedy: impl Into<String>,
    ) -> Self {
        Self {
            kind: Kind::Input,
            place: place.into(),
            problem: problem.into(),
            remedy: remedy.into(),
        }
    }

    /// The work failed at `place` although the input was good.
    pub fn failed(
        place: impl Into<String>,
        problem: impl Into<String>,
        remedy: impl Into<String>,
    ) -> Self {
        Self {
            kind: Kind::Failed,
            place: place.into(),
            problem: problem.into(),
            remedy: remedy.into(),
        }
    }

    /// The user stopped the work.
    pub fn interrupted(problem: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self {
            kind: Kind::Interrupted,
            place: String::new(),
            problem: problem.into(),
            remedy: remedy.into(),
        }
    }

    /// A check stopped the run at `place`.
    pub fn unstable(
        place: impl Into<String>,
        problem: impl Into<String>,
        remedy: impl Into<String>,
    ) -> Self {
        Self {
            kind: Kind::Unstable,
            place: place.into(),
            problem: problem.into(),
            remedy: remedy.into(),
        }
    }

    /// The message, placed within a larger object (a facet of a file).
    #[must_use]
    pub fn within(mut self, outer: &str) -> Self {
        self.place = if self.place.is_empty() {
            outer.to_owned()
        } else {
            format!("{outer}: {}", self.place)
        };
        self
    }

    /// 2 for bad input, 1 for work that failed, 3 for a run that went unstable, 130 for an
    /// interrupted one.
    pub fn exit_code(&self) -> u8 {
        match self.kind {
            Kind::Input => 2,
            Kind::Failed => 1,
            Kind::Interrupted => 130,
            Kind::Unstable => 3,
        }
    }
}

/// On one line: file names and their contents are shown as by [`visible`].
impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if !self.place.is_empty() {
            write!(f, "{}: ", visible(&self.place))?;
        }
        f.write_str(&visible(&self.problem))?;
        if !self.remedy.is_empty() {
            write!(f, "; {}", visible(&self.remedy))?;
        }
        Ok(())
    }
}

impl fmt::Debug for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl std::error::Error for Diagnostic {}
