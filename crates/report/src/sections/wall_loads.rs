//! Where walls are hit and worn, from `wall_loads.csv` and `wall_loads.vtp`.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use dem_io::Result;
use dem_io::units::{show_quantity, significant};
use dem_plots::{Column, Page, Table};
use dem_results::Summary;
use dem_results::folder::names::WALL_LOADS;
use maud::html;

use super::percent::percent;
use crate::folder::Folder;
use crate::wall_loads::{WallQuantity, wall_picture};

/// Number of patches in the table.
const MOST_ROWS: usize = 5;
/// Size of the picture, px.
const SIZE_PX: [u32; 2] = [960, 540];

/// Columns of a patch after the name of its wall.
const COLUMNS: [&str; 7] = [
    "x_m",
    "y_m",
    "z_m",
    "normal_impulse_n_s",
    "impact_j",
    "friction_j",
    "wear_depth_m",
];

/// A patch: the name of its wall, and the values of its [`COLUMNS`].
type Spot = (String, [f64; 7]);

/// Adds the patches with the largest loads, and a picture, if any wall has loads.
pub(crate) fn add_wall_loads(page: &mut Page, summary: &Summary, folder: &Folder) -> Result<()> {
    let Some(spots) = folder.text(WALL_LOADS).and_then(|csv| read(&csv)) else {
        return Ok(());
    };
    let wears = spots.iter().any(|(_, values)| values[6] > 0.0);
    let by = if wears {
        WallQuantity::WearDepth
    } else {
        WallQuantity::Impact
    };
    page.heading("Loads of walls");
    page.paragraph("Sums over the run on patches of the walls, by the largest wear, or impacts where nothing wears; each with its share of its wall:");
    page.table(&table(summary, &spots, wears));
    let png = wall_picture(folder.path(), by, None, (None, 1.0), SIZE_PX)?;
    let source = format!("data:image/png;base64,{}", STANDARD.encode(png));
    page.part(html! {
        img src=(source) width="960" style="max-width: 100%" alt="The walls, coloured by their loads";
    });
    page.small("The walls stand as at the start. All patches: wall_loads.csv, and wall_loads.vtp for ParaView.");
    Ok(())
}

/// The rows of the table of patches. None: it has other columns.
fn read(csv: &str) -> Option<Vec<Spot>> {
    let mut lines = csv.lines();
    let head: Vec<&str> = lines.next()?.split(',').collect();
    let mut places = [0; COLUMNS.len()];
    for (place, name) in places.iter_mut().zip(COLUMNS) {
        *place = head.iter().position(|column| *column == name)?;
    }
    let spot = |line: &str| {
        let cells: Vec<&str> = line.split(',').collect();
        let mut values = [0.0; COLUMNS.len()];
        for (value, place) in values.iter_mut().zip(places) {
            *value = cells.get(place)?.parse().ok()?;
        }
        Some(((*cells.first()?).to_owned(), values))
    };
    lines.map(spot).collect()
}

fn table(summary: &Summary, spots: &[Spot], wears: bool) -> Table {
    let rank = |(_, values): &Spot| values[if wears { 6 } else { 4 }];
    let mut largest: Vec<&Spot> = spots.iter().filter(|spot| rank(spot) > 0.0).collect();
    largest.sort_by(|a, b| rank(b).total_cmp(&rank(a)));
    let row = |(name, values): &&Spot| {
        let [x, y, z, impulse, impact, friction, depth] = *values;
        let total = summary.wall_loads.get(name);
        let total = total.copied().unwrap_or_default().sums;
        let share = |part: f64, all: f64| match all > 0.0 {
            true => format!(" ({})", percent(part / all)),
            false => String::new(),
        };
        let place = [x, y, z].map(|x| significant(1e3 * x, 4)).join(", ");
        let shown = |value, unit, all| show_quantity(value, unit) + &share(value, all);
        let cells = vec![
            name.clone(),
            format!("{place} mm"),
            shown(impulse, "N s", total.normal_impulse_n_s),
            shown(impact, "J", total.impact_j),
            shown(friction, "J", total.friction_j),
            show_quantity(depth, "m"),
        ];
        cells.into()
    };
    let mut columns = vec![Column::text("wall"), Column::text("middle of the patch")];
    let names = ["normal impulse", "impact energy", "friction", "wear depth"];
    columns.extend(names.map(Column::number));
    Table {
        columns,
        rows: largest.iter().take(MOST_ROWS).map(row).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use dem_physics::contact::patch_book::PatchBook;
    use dem_results::summary::WallLoadSummary;

    #[test]
    fn the_most_worn_patches_come_first_with_their_shares() {
        let csv = "wall,x_m,y_m,z_m,normal_impulse_n_s,impact_j,friction_j,wear_depth_m\n\
            liner,0.01,0,0,1,0.5,0,1e-6\nliner,0.02,0,0,3,0.25,2,3e-6\n";
        let spots = read(csv).unwrap_or_default();
        let sums = PatchBook {
            normal_impulse_n_s: 4.0,
            ..PatchBook::default()
        };
        let total = WallLoadSummary {
            sums,
            ..WallLoadSummary::default()
        };
        let summary = Summary {
            wall_loads: [("liner".to_owned(), total)].into(),
            ..Summary::default()
        };
        for (wears, first) in [(true, "20, 0, 0 mm"), (false, "10, 0, 0 mm")] {
            let mut page = Page::new("chute");
            page.table(&table(&summary, &spots, wears));
            let html = page.html();
            let place = |text: &str| html.find(text).unwrap_or(usize::MAX);
            let [one, other] = ["10, 0, 0 mm", "20, 0, 0 mm"].map(place);
            assert_eq!(one.min(other), place(first), "{html}");
            assert!(html.contains("75"), "{html}");
        }
        assert_eq!(read("wall,x_m\nliner,1\n"), None);
    }
}
