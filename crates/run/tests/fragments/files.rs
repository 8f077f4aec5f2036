//! Tables, events and summary of a rod that bursts.

use std::collections::BTreeMap;
use std::fs;

use dem_engine::state::clusters::{Cluster, Split};
use dem_results::columns::header as first_line;
use dem_results::folder::names;
use dem_results::{Existing, FragmentRow, ResultsFolder, read_series};
use dem_runner::outputs::event_table::split_text;
use nalgebra::Vector3;

use super::burst::{PARTICLES, burst, bursting, planned, run_into};
use super::table;

/// A row of fragments.csv.
struct Row {
    id: u32,
    parent_id: Option<u32>,
    particles: u32,
    mass_kg: f64,
    centre: Vector3<f64>,
    velocity: Vector3<f64>,
    spin: Vector3<f64>,
    force: Vector3<f64>,
    equivalent_diameter_m: f64,
    box_diagonal_m: f64,
}

/// The times of fragments.csv, each with its fragments.
fn moments(folder: &ResultsFolder) -> Vec<(f64, Vec<Row>)> {
    let (header, rows) = table(&folder.file(names::FRAGMENTS));
    assert_eq!(header.join(","), first_line(&FragmentRow::COLUMNS));
    let mut moments: Vec<(f64, Vec<Row>)> = Vec::new();
    for row in rows {
        let number = |at: usize| row[at].parse::<f64>().unwrap();
        let vector = |at: usize| Vector3::new(number(at), number(at + 1), number(at + 2));
        let fragment = Row {
            id: row[1].parse().unwrap(),
            parent_id: (!row[2].is_empty()).then(|| row[2].parse().unwrap()),
            particles: row[3].parse().unwrap(),
            mass_kg: number(4),
            centre: vector(5),
            velocity: vector(8),
            spin: vector(11),
            force: vector(14),
            equivalent_diameter_m: number(17),
            box_diagonal_m: number(18),
        };
        match moments.last_mut() {
            Some((time_s, of_moment)) if *time_s == number(0) => of_moment.push(fragment),
            _ => moments.push((number(0), vec![fragment])),
        }
    }
    assert!(moments.is_sorted_by(|a, b| a.0 < b.0));
    moments
}

/// Id, parent, creation time, end time, particles.
type ReadRow = (u32, Option<u32>, f64, Option<f64>, u32);

fn tree(folder: &ResultsFolder) -> Vec<ReadRow> {
    let (header, rows) = table(&folder.file(names::FRAGMENT_TREE));
    assert_eq!(header.join(","), first_line(&dem_results::TreeRow::COLUMNS));
    let known = |text: &str| (!text.is_empty()).then(|| text.to_owned());
    rows.into_iter()
        .map(|row| {
            (
                row[0].parse().unwrap(),
                known(&row[1]).map(|text| text.parse().unwrap()),
                row[2].parse().unwrap(),
                known(&row[3]).map(|text| text.parse().unwrap()),
                row[4].parse().unwrap(),
            )
        })
        .collect()
}

/// Number of fragments in the tree at a time.
fn count_at(tree: &[ReadRow], time_s: f64) -> u64 {
    let lives = |row: &&ReadRow| row.2 <= time_s && row.3.is_none_or(|ended_s| ended_s > time_s);
    tree.iter().filter(lives).count() as u64
}

#[test]
fn fragments_of_every_moment_make_up_the_whole() {
    let (_parent, folder, summary) = burst();
    let moments = moments(&folder);
    let volume = |r: f64| 4.0 / 3.0 * std::f64::consts::PI * r.powi(3);
    let [rod, pair] = [
        PARTICLES as f64 * 2050.0 * volume(1e-3),
        2050.0 * (volume(1e-3) + volume(2e-3)),
    ];
    let momentum = pair * Vector3::new(3.0, 0.0, 1.0);
    for (time_s, fragments) in &moments {
        assert!(fragments.is_sorted_by(|a, b| a.id < b.id));
        let particles: u32 = fragments.iter().map(|f| f.particles).sum();
        assert_eq!(particles as usize, PARTICLES + 2);
        let mass: f64 = fragments.iter().map(|f| f.mass_kg).sum();
        assert!((mass / (rod + pair) - 1.0).abs() < 1e-12, "{mass}");
        // No external force: momentum is conserved, and forces cancel.
        let carried: Vector3<f64> = fragments.iter().map(|f| f.mass_kg * f.velocity).sum();
        let scale: f64 = fragments
            .iter()
            .map(|f| f.mass_kg * f.velocity.norm())
            .sum();
        assert!((carried - momentum).norm() < 1e-9 * scale, "at {time_s}");
        for fragment in fragments {
            let cubes = 3.0 * fragment.mass_kg / (4.0 * std::f64::consts::PI * 2050.0);
            assert!((fragment.equivalent_diameter_m / (2.0 * cubes.cbrt()) - 1.0).abs() < 1e-9);
            assert!(fragment.box_diagonal_m > fragment.equivalent_diameter_m);
        }
    }
    // Before any event: two bodies, the first by name the pair.
    let (time_s, first) = &moments[0];
    assert_eq!(*time_s, 0.0);
    assert_eq!(first.len(), 2);
    assert_eq!(first[0].particles, 2);
    assert_eq!(first[1].particles as usize, PARTICLES);
    assert!(first.iter().all(|f| f.parent_id.is_none()));
    assert!((first[1].spin - Vector3::new(0.0, 0.0, 2500.0)).norm() < 1e-6);
    assert!((first[1].centre - Vector3::new(0.059, 0.0, 0.0)).norm() < 1e-12);
    assert!((first[0].velocity - Vector3::new(3.0, 0.0, 1.0)).norm() < 1e-12);
    assert_eq!(first[1].force, Vector3::zeros());
    let (time_s, last) = &moments[moments.len() - 1];
    assert_eq!(*time_s, summary.simulated_s);
    let said = summary.fragments.unwrap();
    assert_eq!(said.count, last.len());
    let heaviest = last.iter().map(|f| f.mass_kg).fold(0.0, f64::max);
    assert!((said.mass_fraction_of_largest * (rod + pair) / heaviest - 1.0).abs() < 1e-12);
    assert!(last.len() > 12, "{} fragments", last.len());
    // The pair is unchanged, and has its number.
    assert_eq!((last[0].id, last[0].particles), (0, 2));
}

#[test]
fn fragments_are_written_at_frames_and_whenever_they_have_become_many_more() {
    let (_parent, folder, _) = burst();
    let moments = moments(&folder);
    let tree = tree(&folder);
    let times = |count: usize| (0..count).map(|k| k as f64 * 1e-4);
    for time_s in times(6) {
        let is_near = |moment: &&(f64, Vec<Row>)| (moment.0 - time_s).abs() < 1e-6;
        assert!(moments.iter().any(|moment| is_near(&moment)), "{time_s}");
    }
    assert!(moments.len() > 9, "{} moments", moments.len());
    for (time_s, fragments) in &moments {
        assert_eq!(fragments.len() as u64, count_at(&tree, *time_s));
    }
    for pair in moments.windows(2) {
        let [before, after] = [&pair[0], &pair[1]].map(|moment| moment.1.len());
        let is_frame = times(6).any(|time_s| (pair[1].0 - time_s).abs() < 1e-6);
        assert!(is_frame || after > before + before / 20);
    }
    // And no row of the time series with many more was skipped.
    for time_s in read_series(&folder.file(names::SERIES)).unwrap().times_s {
        let last = moments.iter().rfind(|moment| moment.0 <= time_s).unwrap();
        let written = last.1.len() as u64;
        assert!(count_at(&tree, time_s) <= written + written / 20);
    }
}

#[test]
fn the_tree_tells_who_broke_off_whom() {
    let (_parent, folder, summary) = burst();
    let tree = tree(&folder);
    let mut children: BTreeMap<u32, Vec<&ReadRow>> = BTreeMap::new();
    for row in &tree {
        if let Some(parent) = row.1 {
            children.entry(parent).or_default().push(row);
        }
    }
    for (number, (id, parent, created_s, ended_s, particles)) in (0..).zip(&tree) {
        assert_eq!(*id, number);
        assert_eq!(parent.is_none(), number < 2);
        assert_eq!(parent.is_none(), *created_s == 0.0);
        match ended_s {
            None => assert!(!children.contains_key(id)),
            Some(ended_s) => {
                let children = &children[id];
                assert!(children.len() > 1);
                assert!(children.iter().all(|child| child.2 == *ended_s));
                let of_children: u32 = children.iter().map(|child| child.4).sum();
                assert_eq!(of_children, *particles);
            }
        }
    }
    let said = summary.fragments.unwrap();
    assert_eq!(said.splits, children.len());
    let living = tree.iter().filter(|row| row.3.is_none());
    assert_eq!(said.count, living.count());
    // Fragments of the table have the parents and particles of the tree.
    for fragment in moments(&folder).iter().flat_map(|moment| &moment.1) {
        let (_, parent, _, _, particles) = tree[fragment.id as usize];
        assert_eq!(
            (fragment.parent_id, fragment.particles),
            (parent, particles)
        );
    }
}

#[test]
fn every_split_is_an_event() {
    let (_parent, folder, summary) = burst();
    let tree = tree(&folder);
    let text = fs::read_to_string(folder.file(names::EVENTS)).unwrap();
    let splits: Vec<&str> = text
        .lines()
        .filter(|line| line.contains(",split,"))
        .collect();
    assert_eq!(splits.len(), summary.fragments.unwrap().splits);
    let mut parents = Vec::new();
    for line in splits {
        let (time, detail) = line.split_once(",split,,,,,,,,,\"fragment ").unwrap();
        let time_s: f64 = time.split(',').nth(1).unwrap().parse().unwrap();
        let parent: usize = detail.split_once(" -> ").unwrap().0.parse().unwrap();
        assert_eq!(tree[parent].3, Some(time_s));
        assert!(detail.ends_with(" particles)\",,"), "{detail}");
        parents.push(parent);
    }
    parents.sort_unstable();
    let ended: Vec<usize> = (0..tree.len()).filter(|id| tree[*id].3.is_some()).collect();
    assert_eq!(parents, ended);
}

#[test]
fn the_text_of_a_split_is_short_however_many_pieces_there_are() {
    let cluster = |particles: u32| Cluster {
        parent: None,
        body: 0,
        created_s: 0.0,
        unbroken_since_s: 0.0,
        ended_s: None,
        particles,
    };
    let clusters =
        |counts: &[u32]| -> Vec<Cluster> { counts.iter().map(|count| cluster(*count)).collect() };
    let split = |children: std::ops::Range<u32>| Split {
        parent: 3,
        children: children.collect(),
    };
    let few = clusters(&[9, 9, 9, 1242, 38, 1204]);
    assert_eq!(
        split_text(&split(4..6), &few),
        "fragment 3 -> 5, 4 (1204 + 38 particles)"
    );
    let nine = clusters(&[1, 2, 3, 4, 5, 6, 7, 8, 9]);
    assert_eq!(
        split_text(&split(0..9), &nine),
        "fragment 3 -> 8, 7, 6, 5, 4, 3, 2, 1 (9 + 8 + 7 + 6 + 5 + 4 + 3 + 2 particles) and 1 more (1 particle)"
    );
    let mut dust = vec![1; 100_000];
    dust[70_000] = 500;
    let text = split_text(&split(0..100_000), &clusters(&dust));
    assert_eq!(
        text,
        "fragment 3 -> 70000, 0, 1, 2, 3, 4, 5, 6 (500 + 1 + 1 + 1 + 1 + 1 + 1 + 1 particles) and 99992 more (99992 particles)"
    );
}

#[test]
fn the_summary_says_what_the_bodies_broke_into() {
    let (_parent, folder, summary) = burst();
    let said = summary.fragments.unwrap();
    let text = summary.to_string();
    let begin = format!("\nfragments    {}, the largest 0.", said.count);
    assert!(text.contains(&begin), "{text}");
    let json: serde_json::Value =
        serde_json::from_slice(&fs::read(folder.file(names::SUMMARY)).unwrap()).unwrap();
    assert_eq!(json["fragments"]["count"], said.count);
    assert_eq!(json["fragments"]["splits"], said.splits);
    let fraction = json["fragments"]["mass_fraction_of_largest"].as_f64();
    assert_eq!(fraction, Some(said.mass_fraction_of_largest));
}

#[test]
fn where_nothing_can_break_nothing_is_said_of_fragments() {
    let parent = tempfile::tempdir().unwrap();
    let folder = ResultsFolder::create(&parent.path().join("out"), Existing::Refuse).unwrap();
    let mut scene = bursting();
    scene.run.end_time_s = 2e-5;
    let mut plan = planned(&scene);
    plan.state.clusters = None;
    let summary = run_into(&folder, plan, &scene, None, 2.0).unwrap();
    assert!(!summary.to_string().contains("fragments"));
    assert!(
        !fs::read_to_string(folder.file(names::SUMMARY))
            .unwrap()
            .contains("fragments")
    );
    assert!(folder.file(names::SERIES).exists());
    for path in [
        folder.file(names::FRAGMENTS),
        folder.file(names::FRAGMENT_TREE),
        folder.plot("fragments"),
        folder.plot("fragment_sizes"),
    ] {
        assert!(!path.exists(), "{}", path.display());
    }
    let frame = fs::read(folder.frame(0)).unwrap();
    let header = String::from_utf8_lossy(&frame);
    for name in ["\"fragment_id\"", "\"fragment_mass_kg\""] {
        assert!(!header.contains(name), "{name}");
    }
    // With these a piece can be taken as a body all the same.
    for name in [
        "\"density_kg_m3\"",
        "\"initial_length_m\"",
        "\"rotation_rad\"",
    ] {
        assert!(header.contains(name), "{name}");
    }
}
