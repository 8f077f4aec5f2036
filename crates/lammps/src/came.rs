//! What a run of LAMMPS came to.

/// What a run of LAMMPS came to.
#[derive(Debug, Clone, Copy, Default)]
pub struct Came {
    /// Frames written.
    pub frames: usize,
    /// Bonds that broke.
    pub broken: u64,
    /// Fragments at the end: an intact body is one.
    pub fragments: usize,
    /// Time of the last frame, and of the end of the run, s.
    pub last_s: f64,
    pub(crate) end_s: f64,
    /// Whether the last frame is that of the end.
    pub(crate) is_whole: bool,
}

impl Came {
    /// What is to be said of a run that has not come to its end.
    pub fn warning(&self) -> Option<String> {
        let Self { last_s, end_s, .. } = self;
        let warning = format!(
            "the frames end at {last_s} s, the run of the scene at {end_s} s: LAMMPS has stopped before, or goes on"
        );
        (!self.is_whole).then_some(warning)
    }
}
