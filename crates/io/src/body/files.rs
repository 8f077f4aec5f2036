//! Reading and writing of bodies as files or through pipes; the ending of the name gives the
//! format.

use std::ffi::OsStr;
use std::fs;
use std::io::{self, BufRead, BufReader, ErrorKind, IsTerminal};
use std::path::{Path, PathBuf};

use super::histories::are_more_than_sums;
use super::parts::Body;
use super::stored_frame::StoredFrame;
use super::stored_particles::StoredParticles;
use super::stored_walls::{FIXED_WALLS_FILE, StoredWalls};
use super::{csv, lammps, txt, vtp};
use crate::diagnostic::{Diagnostic, Result};
use crate::input_file::{BUFFER_BYTES, explain_read, open_input};
use crate::safe_write::{PendingFile, explain, write_file, write_standard_bytes};
use crate::triangles::{is_named_so, refusal_by_name};

/// The form in which a body is stored, with the names of its files.
enum Storage {
    /// One .vtp file through standard input or output.
    Pipe,
    Vtp(PathBuf),
    Lammps(PathBuf),
    Csv(Pair),
    Txt(Pair),
}

/// The two files of a body.
struct Pair {
    particles: PathBuf,
    bonds: PathBuf,
}

impl Pair {
    /// `cake.csv`, `cake.particles.csv` or `cake.bonds.csv` -> `cake.particles.csv` and
    /// `cake.bonds.csv`.
    fn named(path: &Path) -> Self {
        let ending = path.extension().unwrap_or_default();
        let name = path.with_extension("");
        let stem = match name.extension().and_then(OsStr::to_str) {
            Some("particles" | "bonds") => name.with_extension(""),
            _ => name,
        };
        let file = |part: &str| {
            let mut file = stem.clone().into_os_string();
            for piece in [OsStr::new(part), ending] {
                file.push(".");
                file.push(piece);
            }
            PathBuf::from(file)
        };
        Self {
            particles: file("particles"),
            bonds: file("bonds"),
        }
    }

    fn read(
        &self,
        read: impl FnOnce(&mut dyn BufRead, &mut dyn BufRead) -> Result<Body>,
    ) -> Result<Body> {
        let particles = open_input(&self.particles)?;
        let mut bonds = open_input(&self.bonds)?;
        self.read_with(particles, &mut bonds, read)
    }

    /// Reads the spheres, and the bonds if there is a file of bonds; `no_bonds` is such a file
    /// without bonds.
    fn read_spheres(
        &self,
        mut no_bonds: &[u8],
        read: impl FnOnce(&mut dyn BufRead, &mut dyn BufRead) -> Result<Body>,
    ) -> Result<Body> {
        if self.bonds.exists() {
            self.read(read)
        } else {
            self.read_with(open_input(&self.particles)?, &mut no_bonds, read)
        }
    }

    fn read_with(
        &self,
        mut particles: impl BufRead,
        bonds: &mut dyn BufRead,
        read: impl FnOnce(&mut dyn BufRead, &mut dyn BufRead) -> Result<Body>,
    ) -> Result<Body> {
        // The readers name the file "particles" or "bonds".
        read(&mut particles, bonds).map_err(|mut error| {
            for (part, path) in [("particles", &self.particles), ("bonds", &self.bonds)] {
                if let Some(place) = error
                    .place
                    .strip_prefix(part)
                    .and_then(|rest| rest.strip_prefix(": "))
                {
                    error.place = format!("{}: {place}", path.display());
                    return error;
                }
            }
            error.within(&self.particles.display().to_string())
        })
    }

    fn write(
        &self,
        particles: impl FnOnce(&mut dyn io::Write) -> io::Result<()>,
        bonds: impl FnOnce(&mut dyn io::Write) -> io::Result<()>,
    ) -> Result<()> {
        let particles = PendingFile::write(&self.particles, particles)?;
        let bonds = PendingFile::write(&self.bonds, bonds)?;
        // The spheres go first and come last: whatever stops this in between leaves bonds alone,
        // which nothing reads, and never the spheres of one body beside the bonds of another.
        if self.particles.is_file() {
            let old = fs::canonicalize(&self.particles);
            let removed = old.and_then(fs::remove_file);
            removed.map_err(|error| explain(&self.particles, &error))?;
        }
        bonds.publish()?;
        particles.publish()
    }
}

impl Storage {
    fn named(path: &Path) -> Result<Self> {
        if path == Path::new("-") {
            return Ok(Self::Pipe);
        }
        let ending = path
            .extension()
            .unwrap_or_default()
            .to_string_lossy()
            .to_ascii_lowercase();
        match ending.as_str() {
            "vtp" => Ok(Self::Vtp(path.to_owned())),
            "data" | "lmp" | "lammps" => Ok(Self::Lammps(path.to_owned())),
            "csv" => Ok(Self::Csv(Pair::named(path))),
            "txt" => Ok(Self::Txt(Pair::named(path))),
            _ if path.is_dir() => {
                let error = ErrorKind::IsADirectory.into();
                Err(explain_read(path, &error, "a file"))
            }
            _ => {
                let problem = if ending.is_empty() {
                    "the name has no ending that says which format is meant".to_owned()
                } else {
                    format!("'.{ending}' is not the ending of a body")
                };
                Err(Diagnostic::input(
                    path.display().to_string(),
                    problem,
                    "use .vtp (ParaView), .data, .lmp or .lammps (LAMMPS), .csv (two tables), .txt (two tables of plain \
                     numbers), or - for a pipe",
                ))
            }
        }
    }
}

/// The files of a body that is written to `path`: one, two (.csv, .txt), or none (`-`, standard
/// output). Refuses an unknown ending.
pub fn body_files(path: &Path) -> Result<Vec<PathBuf>> {
    Ok(match Storage::named(path)? {
        Storage::Pipe => Vec::new(),
        Storage::Vtp(path) | Storage::Lammps(path) => vec![path],
        Storage::Csv(pair) | Storage::Txt(pair) => vec![pair.particles, pair.bonds],
    })
}

/// Reads a body from `path`; `-` is a .vtp on standard input. For .csv and .txt either file of the
/// pair may be given, or their common name (`cake.csv`). Refuses what is not a body by
/// [`Body::check`].
pub fn read_body(path: &Path) -> Result<Body> {
    refuse_shape(path)?;
    let within = |error: Diagnostic| error.within(&path.display().to_string());
    match Storage::named(path)? {
        Storage::Pipe => {
            let input = io::stdin();
            if input.is_terminal() {
                let remedy = "pipe a .vtp into it, or name a file";
                return Err(Diagnostic::input(
                    "standard input",
                    "this is a terminal, not a body",
                    remedy,
                ));
            }
            let mut input = BufReader::with_capacity(BUFFER_BYTES, input.lock());
            vtp::read(&mut input).map_err(|error| error.within("standard input"))
        }
        Storage::Vtp(path) => vtp::read(&mut open_input(&path)?).map_err(within),
        Storage::Lammps(path) => lammps::read(&mut open_input(&path)?).map_err(within),
        Storage::Csv(pair) => pair.read(csv::read),
        Storage::Txt(pair) => pair.read(txt::read),
    }
}

/// As [`read_body`], also of a list of spheres without bonds: a .csv or .txt of particles that has
/// no file of bonds beside it, under its own name or that of the pair.
pub fn read_spheres(path: &Path) -> Result<Body> {
    refuse_shape(path)?;
    let of_list = |mut pair: Pair| {
        if !pair.particles.exists() && path.is_file() {
            pair.particles = path.to_owned();
        }
        pair
    };
    match Storage::named(path)? {
        Storage::Csv(pair) => {
            let mut no_bonds = Vec::new();
            csv::write_bonds(&Body::default(), &mut no_bonds)
                .map_err(|error| Diagnostic::failed("", error.to_string(), ""))?;
            of_list(pair).read_spheres(&no_bonds, csv::read)
        }
        Storage::Txt(pair) => of_list(pair).read_spheres(b"", txt::read),
        _ => read_body(path),
    }
}

/// Reads a frame of a run; refuses one without fragments.
pub fn read_frame(path: &Path) -> Result<StoredFrame> {
    let mut file = open_input(path)?;
    vtp::read_frame(&mut file).map_err(|error| error.within(&path.display().to_string()))
}

/// Reads the particles and bonds of a frame of any run.
pub fn read_particles(path: &Path) -> Result<StoredParticles> {
    let mut file = open_input(path)?;
    vtp::read_particles(&mut file).map_err(|error| error.within(&path.display().to_string()))
}

/// Reads the walls of a frame of a run, `frames/walls_000123.vtp`, together with the walls that
/// never move and are written once, next to it.
pub fn read_walls(path: &Path) -> Result<StoredWalls> {
    let read = |path: &Path| {
        let mut file = open_input(path)?;
        vtp::read_walls(&mut file).map_err(|error| error.within(&path.display().to_string()))
    };
    let mut walls = read(path)?;
    if walls.has_fixed {
        walls.add(&read(&path.with_file_name(FIXED_WALLS_FILE))?);
    }
    let within = |error: Diagnostic| error.within(&path.display().to_string());
    walls.check().map_err(within)?;
    Ok(walls)
}

/// Writes a body to `path`; `-` is a .vtp on standard output, whose reader may close it early.
/// Files appear complete or not at all; of two files, neither appears before both are written.
///
/// # Errors
/// Not a body by [`Body::check`], or more than such a file holds; an unknown ending; a terminal.
pub fn write_body(body: &Body, path: &Path) -> Result<()> {
    let storage = Storage::named(path)?;
    body.check()?;
    let is_damaged = body.bond_damages.iter().any(|damage| *damage > 0.0);
    let has_history = are_more_than_sums(&body.bond_histories);
    let is_lost = match storage {
        Storage::Pipe | Storage::Vtp(_) => None,
        _ if is_damaged || has_history => Some("bonds with damage or a history"),
        _ if body.is_sheared() => Some("bonds that are bent, twisted or sheared"),
        Storage::Lammps(_) | Storage::Txt(_) if body.is_stretched() => {
            Some("bonds that are stretched or pressed")
        }
        _ => None,
    };
    if let Some(lost) = is_lost {
        return Err(Diagnostic::input(
            path.display().to_string(),
            format!("the body has {lost}, which such a file does not hold"),
            "write a .vtp",
        ));
    }
    match storage {
        Storage::Pipe => {
            if io::stdout().is_terminal() {
                let remedy = "write it to a file, or pipe it into another program";
                return Err(Diagnostic::input(
                    "standard output",
                    "a .vtp is no text for a terminal",
                    remedy,
                ));
            }
            write_standard_bytes(|out| vtp::write(body, out))
        }
        Storage::Vtp(path) => write_file(&path, |out| vtp::write(body, out)),
        Storage::Lammps(path) => write_file(&path, |out| lammps::write(body, out)),
        Storage::Csv(pair) => pair.write(
            |out| csv::write_particles(body, out),
            |out| csv::write_bonds(body, out),
        ),
        Storage::Txt(pair) => pair.write(
            |out| txt::write_particles(body, out),
            |out| txt::write_bonds(body, out),
        ),
    }
}

/// Refuses a shape where a body is read.
fn refuse_shape(path: &Path) -> Result<()> {
    let name = path.display().to_string();
    if let Some(refusal) = refusal_by_name(path) {
        return Err(refusal.within(&name));
    }
    if !is_named_so(path) {
        return Ok(());
    }
    let body = path.with_extension("vtp");
    let remedy = format!(
        "fill it first: dem-pack {name} --diameter 2mm..3mm -o {}",
        body.display()
    );
    Err(Diagnostic::input(
        name,
        "this is a shape, not a body",
        remedy,
    ))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    /// A write that stops between its two files leaves no spheres beside bonds of another body.
    #[test]
    fn half_a_pair_has_no_spheres() {
        let folder = tempfile::tempdir().unwrap();
        let pair = Pair::named(&folder.path().join("cake.csv"));
        fs::write(&pair.particles, "old").unwrap();
        let stopped = pair.write(|out| out.write_all(b"new"), |_| fs::create_dir(&pair.bonds));
        assert!(stopped.is_err());
        assert!(!pair.particles.exists());
    }

    /// The files that links name are replaced, and the links stay.
    #[cfg(unix)]
    #[test]
    fn a_pair_behind_links_is_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let [real, link] =
            ["real.csv", "link.csv"].map(|name| Pair::named(&folder.path().join(name)));
        for (real, link) in [
            (&real.particles, &link.particles),
            (&real.bonds, &link.bonds),
        ] {
            fs::write(real, "old").unwrap();
            std::os::unix::fs::symlink(real, link).unwrap();
        }
        let written = link.write(|out| out.write_all(b"new"), |out| out.write_all(b"bonds"));
        written.unwrap();
        assert!(link.particles.is_symlink());
        assert_eq!(fs::read(&real.particles).unwrap(), b"new");
        assert_eq!(fs::read(&real.bonds).unwrap(), b"bonds");
    }
}
