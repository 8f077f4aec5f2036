//! The patches of walls and what contacts have done to them, as triangles: from `wall_loads.vtp`,
//! or a file beside a frame.

use std::path::Path;

use dem_io::{Diagnostic, Result};
use dem_results::read_arrays;

/// What the colours of walls show.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum WallQuantity {
    /// Depth worn off, m.
    WearDepth,
    /// Energy of impacts over area, J/m2.
    Impact,
    /// Energy lost to friction over area, J/m2.
    Friction,
    /// Impulse along the normal over area, N s/m2.
    NormalImpulse,
}

impl WallQuantity {
    /// Their names.
    pub const WORDS: [(&'static str, Self); 4] = [
        ("wear_depth", Self::WearDepth),
        ("impact", Self::Impact),
        ("friction", Self::Friction),
        ("normal_impulse", Self::NormalImpulse),
    ];

    /// Its name on a scale, and its unit.
    pub(crate) fn label(self) -> (&'static str, &'static str) {
        match self {
            Self::WearDepth => ("wear depth", "m"),
            Self::Impact => ("impact energy over area", "J/m2"),
            Self::Friction => ("friction over area", "J/m2"),
            Self::NormalImpulse => ("normal impulse over area", "N s/m2"),
        }
    }

    /// Its column, and whether it is divided by the area.
    fn column(self) -> (&'static str, bool) {
        match self {
            Self::WearDepth => ("wear_depth_m", false),
            Self::Impact => ("impact_j", true),
            Self::Friction => ("friction_j", true),
            Self::NormalImpulse => ("normal_impulse_n_s", true),
        }
    }
}

/// The patches as triangles, where the walls stand.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct LoadCells {
    /// Corners, m.
    pub(crate) triangles_m: Vec<[[f64; 3]; 3]>,
    /// For each triangle the quantities in the order of [`WallQuantity::WORDS`], SI units.
    pub(crate) values: Vec<[f64; 4]>,
}

impl LoadCells {
    /// Reads such a file.
    ///
    /// # Errors
    /// The file cannot be read, or is damaged.
    pub(crate) fn read(path: &Path) -> Result<Self> {
        let (points, corners, area) = (
            "Points/positions_m",
            "Polys/connectivity",
            "CellData/area_m2",
        );
        let columns = WallQuantity::WORDS.map(|(_, quantity)| quantity.column());
        let names = columns.map(|(name, _)| format!("CellData/{name}"));
        let mut wanted = vec![points, corners, area];
        wanted.extend(names.iter().map(String::as_str));
        let arrays = read_arrays(path, &wanted)?;
        let get = |name: &str| {
            arrays.get(name).ok_or_else(|| {
                let place = path.display().to_string();
                Diagnostic::input(place, format!("{name} is missing"), "run it again")
            })
        };
        let points_m = get(points)?;
        let point = |number: f64| {
            let first = 3 * number as usize;
            let at = points_m.get(first..first + 3);
            at.map_or([f64::NAN; 3], |at| [at[0], at[1], at[2]])
        };
        let triangles = get(corners)?.chunks_exact(3);
        let triangles_m: Vec<[[f64; 3]; 3]> = triangles
            .map(|t| [point(t[0]), point(t[1]), point(t[2])])
            .collect();
        let areas_m2 = get(area)?;
        let mut values = vec![[0.0; 4]; triangles_m.len()];
        for (k, (name, (_, over_area))) in names.iter().zip(columns).enumerate() {
            for (of, (value, area_m2)) in values.iter_mut().zip(get(name)?.iter().zip(areas_m2)) {
                of[k] = if over_area { value / area_m2 } else { *value };
            }
        }
        Ok(Self {
            triangles_m,
            values,
        })
    }

    /// Without the triangles on which nothing has pressed.
    pub(crate) fn touched(self) -> Self {
        let both = self.triangles_m.into_iter().zip(self.values);
        let touched = both.filter(|(_, values)| values.iter().any(|value| *value != 0.0));
        let (triangles_m, values) = touched.unzip();
        Self {
            triangles_m,
            values,
        }
    }
}
