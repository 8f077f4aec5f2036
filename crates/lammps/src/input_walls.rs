//! The walls in the input script.

use super::input::Input;
use super::wall_motion::SurfaceMotion;
use super::walls::{WrittenShape, WrittenSurface, WrittenWall, flat_degrees};

/// `fix surface/global` is in LAMMPS from this version on.
pub(super) const SURFACES_SINCE: &str = "20260704";

impl Input<'_> {
    /// Whether the running LAMMPS has surfaces, and its end if it needs them and has none.
    pub(super) fn add_version(&self, text: &mut String) {
        let surfaces: Vec<&WrittenWall> = (self.walls.iter())
            .filter(|wall| wall.surface().is_some())
            .collect();
        if surfaces.is_empty() {
            return;
        }
        let needs = surfaces.iter().filter(|wall| needs_surfaces(wall));
        let names: Vec<&str> = needs.map(|wall| wall.name.as_str()).collect();
        for line in [
            "# Surfaces are in LAMMPS of 4 July 2026 with the package GRANSURF, and in later ones.",
            "# lmp -var surfaces 0 -in in.lammps: without them",
        ] {
            Self::line(text, line);
        }
        Self::line(
            text,
            format!(
                "if \"$(is_defined(variable,surfaces)) == 0\" then \"variable surfaces equal $(version>={SURFACES_SINCE})\""
            ),
        );
        if !names.is_empty() {
            Self::line(
                text,
                format!(
                    "if \"${{surfaces}} == 0\" then \"print 'ERROR: the walls {} are surfaces, which LAMMPS has from version {SURFACES_SINCE} on, with the package GRANSURF; this one is $(version)'\" \"quit 1\"",
                    names.join(", ")
                ),
            );
        }
    }

    /// The walls.
    pub(super) fn add_walls(&self, text: &mut String) {
        for wall in self.walls {
            Self::line(text, format!("# wall {}", wall.name));
            match &wall.shape {
                WrittenShape::Region(region, moves) => {
                    let mut moved = String::new();
                    if let Some(formulas) = moves {
                        moved = format!(" move {}", self.add_formulas(text, wall, "", formulas));
                    }
                    let number = wall.number;
                    let region = format!("region wall_{number} {region} units box{moved}");
                    Self::line(text, region);
                    for fix in self.region_fixes(wall) {
                        Self::line(text, fix);
                    }
                }
                WrittenShape::Surface(surface) => self.add_surface(text, wall, surface),
            }
        }
    }

    /// A surface; if LAMMPS has none, as planes.
    fn add_surface(&self, text: &mut String, wall: &WrittenWall, surface: &WrittenSurface) {
        let motion = match &surface.motion {
            SurfaceMotion::Stands => None,
            SurfaceMotion::Turns(how) => Some(format!("rotate {how}")),
            SurfaceMotion::Travels {
                displacement_m,
                velocity_m_s,
            } => {
                let along = self.add_formulas(text, wall, "", displacement_m);
                let speeds = self.add_formulas(text, wall, "v", velocity_m_s);
                Some(format!("variable {along} {speeds}"))
            }
        };
        let mut lines = Vec::new();
        for (id, group, law) in self.meetings(wall) {
            let (file, flat) = (wall.file(), flat_degrees());
            lines.push(format!(
                "fix {id} {group} surface/global input stl 1 1 {file} model * 1 granular {law} flat {flat} neighbor nsq"
            ));
            let moves = (motion.iter()).map(|how| format!("fix_modify {id} move 1 {how}"));
            lines.extend(moves);
        }
        if lines.is_empty() {
            return;
        }
        let Ok(planes) = &surface.planes else {
            for line in lines {
                Self::line(text, line);
            }
            return;
        };
        let mut instead = Vec::new();
        let mut names = String::new();
        for (part, plane) in (1..).zip(planes) {
            let name = format!("wall_{}_part_{part}", wall.number);
            instead.push(format!("region {name} {plane} units box"));
            names += &format!(" {name}");
        }
        let (number, count) = (wall.number, planes.len());
        instead.push(format!("region wall_{number} intersect {count}{names}"));
        instead.extend(self.region_fixes(wall));
        let quoted = |lines: Vec<String>| {
            let each = lines.into_iter().map(|line| format!("  \"{line}\" &\n"));
            each.collect::<String>()
        };
        let (surfaces, instead) = (quoted(lines), quoted(instead));
        let instead = instead.trim_end_matches(" &\n");
        Self::line(
            text,
            format!("if \"${{surfaces}} != 0\" then &\n{surfaces}else &\n{instead}"),
        );
    }

    /// Writes formulas along x, y and z as variables. Returns how they are named in commands.
    fn add_formulas(
        &self,
        text: &mut String,
        wall: &WrittenWall,
        of: &str,
        formulas: &[String; 3],
    ) -> String {
        let mut names = Vec::new();
        for (axis, formula) in ["x", "y", "z"].into_iter().zip(formulas) {
            let name = format!("wall_{}_{of}{axis}", wall.number);
            Self::line(text, format!("variable {name} equal \"{formula}\""));
            names.push(format!("v_{name}"));
        }
        names.join(" ")
    }

    /// The fixes of a wall whose region is there.
    fn region_fixes(&self, wall: &WrittenWall) -> Vec<String> {
        let fix = |(id, group, law): (String, String, &str)| {
            let number = wall.number;
            format!("fix {id} {group} wall/gran/region granular {law} region wall_{number}")
        };
        self.meetings(wall).into_iter().map(fix).collect()
    }

    /// For each group of particles that a wall meets, the name of a fix, the group and the law.
    fn meetings<'a>(&self, wall: &'a WrittenWall) -> Vec<(String, String, &'a str)> {
        let mut meetings = Vec::new();
        let number = wall.number;
        for (material, law) in &wall.laws {
            let material = material + 1;
            let id = format!("wall_{number}_{material}");
            meetings.push((id, format!("material_{material}"), law.as_str()));
            let fed = self.feeds.iter().filter(|f| f.material + 1 == material);
            for group in fed.map(super::feeds::Feed::group) {
                meetings.push((format!("wall_{number}_{group}"), group, law.as_str()));
            }
        }
        meetings
    }
}

/// Whether a wall cannot be written without surfaces.
pub(super) fn needs_surfaces(wall: &WrittenWall) -> bool {
    wall.surface()
        .is_some_and(|surface| surface.planes.is_err())
}
