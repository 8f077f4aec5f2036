//! `include`: tables from other files, and files made of a scene's tables.

use std::fs;
use std::path::{Path, PathBuf};

use dem_io::Result;
use dem_scene::{
    Scene, include_text, material_text, read_scene, scene_from_text, set_text, written_value,
};

const SCENE: &str = r#"version = 1
include = ["cake.toml"]
[run]
end_time = "1 s"
[bodies.cake]
particles = [[0, 0, 0, 0.01], [0.02, 0, 0, 0.01]]
bond_list = [[0, 1]]
material = "cake"
bonds = "cake"
"#;
const CAKE: &str = r#"[materials.cake]
density = 2050
shear_modulus = "10 MPa"
poisson_ratio = 0.3
[contacts]
cake-cake = { friction = 0.5, restitution = 0.3 }
[bonds.cake]
young_modulus = "15 MPa"
poisson_ratio = 0.3
failure = { tensile_strength = "0.2 MPa", shear_strength = 1e5 }
"#;

struct Folder(tempfile::TempDir);

impl Folder {
    fn new(files: &[(&str, &str)]) -> Self {
        let folder = tempfile::tempdir().unwrap();
        for (name, text) in files {
            fs::write(folder.path().join(name), text).unwrap();
        }
        Self(folder)
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn read(&self, overrides: &[String]) -> Result<Scene> {
        read_scene(&self.path("scene.toml"), overrides)
    }
}

#[test]
fn tables_of_an_included_file_are_those_of_the_scene() {
    let folder = Folder::new(&[("scene.toml", SCENE), ("cake.toml", CAKE)]);
    let included = folder.read(&[]).unwrap();
    let whole = scene_from_text(
        &SCENE.replace("include = [\"cake.toml\"]\n", CAKE_FIRST),
        "s",
        &[],
    );
    // The same tables within the scene.
    let mut whole = whole.unwrap();
    whole.source.clone_from(&included.source);
    whole.included.clone_from(&included.included);
    assert_eq!(included, whole);
    assert_eq!(included.included, [folder.path("cake.toml")]);
    assert!(included.input_files().contains(&folder.path("cake.toml")));
    assert!(included.describe().contains("cake.toml"));
    // Values of included tables can be set.
    let set = folder
        .read(&["bonds.cake.young_modulus=20 MPa".to_owned()])
        .unwrap();
    assert_eq!(set.bonds["cake"].young_modulus_pa, 20e6);
}

/// The same tables in lines that may stand before others.
const CAKE_FIRST: &str = r#"materials.cake = { density = 2050, shear_modulus = "10 MPa", poisson_ratio = 0.3 }
contacts.cake-cake = { friction = 0.5, restitution = 0.3 }
bonds.cake = { young_modulus = "15 MPa", poisson_ratio = 0.3, failure = { tensile_strength = "0.2 MPa", shear_strength = 1e5 } }
"#;

#[test]
fn files_named_by_set_stand_above_the_scene() {
    let other = CAKE.replace("15 MPa", "30 MPa");
    let own = SCENE.replace("include = [\"cake.toml\"]\n", CAKE_FIRST);
    let folder = Folder::new(&[("scene.toml", &own), ("other.toml", &other)]);
    let name = folder.path("other.toml").display().to_string();
    let scene = folder
        .read(&[include_text(std::slice::from_ref(&name))])
        .unwrap();
    assert_eq!(scene.bonds["cake"].young_modulus_pa, 30e6);
    assert_eq!(scene.contacts.len(), 1);
    assert_eq!(
        scene.notes,
        [format!(
            "--material {name} changes bonds.cake.young_modulus = \"15 MPa\" to \"30 MPa\""
        )]
    );
    // A value that is set stands above the file, whatever the order.
    let both = [
        "bonds.cake.young_modulus=40 MPa".to_owned(),
        include_text(&[name]),
    ];
    let scene = folder.read(&both).unwrap();
    assert_eq!(scene.bonds["cake"].young_modulus_pa, 40e6);
}

/// The keys that a file does not have stay, and are named; strengths and laws are not mixed.
#[test]
fn keys_that_a_file_does_not_have_stay() {
    let own = SCENE.replace("include = [\"cake.toml\"]\n", CAKE_FIRST)
        .replace(
            "failure = { tensile_strength = \"0.2 MPa\", shear_strength = 1e5 }",
            "damping = { damping_ratio = 0.1 }, failure = { tensile_strength = \"0.2 MPa\", shear_strength = 1e5, weibull_modulus = 8 }",
        );
    let found = CAKE
        .replace(
            "tensile_strength = \"0.2 MPa\", shear_strength = 1e5",
            "von_mises_strength = 3e5",
        )
        .replace("friction = 0.5", "law = \"linear\", normal_stiffness = 1e5");
    let folder = Folder::new(&[("scene.toml", &own), ("found.toml", &found)]);
    let name = folder.path("found.toml").display().to_string();
    let scene = folder
        .read(&[include_text(std::slice::from_ref(&name))])
        .unwrap();
    let bond = &scene.bonds["cake"];
    assert_eq!(bond.failure.weibull_modulus, Some(8.0));
    assert_eq!(bond.failure.von_mises_strength_pa, Some(3e5));
    assert_eq!(bond.failure.tensile_strength_pa, None);
    assert_eq!(
        scene.notes,
        [
            format!(
                "--material {name} replaces contacts.cake-cake as a whole, as its law is another one: it was {{ friction = 0.5, restitution = 0.3 }}"
            ),
            format!(
                "--material {name} removes bonds.cake.failure.tensile_strength = \"0.2 MPa\", bonds.cake.failure.shear_strength = 1e5; it does not have bonds.cake.damping = {{ damping_ratio = 0.1 }}, bonds.cake.failure.weibull_modulus = 8, which the scene keeps"
            ),
        ]
    );
}

/// Files of the scene stay when others are added.
#[test]
fn files_are_added_to_those_of_the_scene() {
    let bonds = CAKE.find("[bonds").unwrap();
    let scene = SCENE.replace("\"cake.toml\"", "\"steel.toml\", \"bonds.toml\"");
    let folder = Folder::new(&[
        ("scene.toml", &scene),
        ("steel.toml", &CAKE[..bonds]),
        ("bonds.toml", &CAKE[bonds..]),
        ("other.toml", &CAKE[bonds..].replace("15 MPa", "30 MPa")),
    ]);
    let [own, other] = ["bonds.toml", "other.toml"]
        .map(|name| include_text(&[folder.path(name).display().to_string()]));
    let modulus =
        |overrides: &[String]| folder.read(overrides).unwrap().bonds["cake"].young_modulus_pa;
    assert_eq!(modulus(&[]), 15e6);
    assert_eq!(modulus(std::slice::from_ref(&own)), 15e6);
    assert_eq!(modulus(std::slice::from_ref(&other)), 30e6);
    assert_eq!(modulus(&[own, other.clone()]), 30e6);
    let steel = folder.path("steel.toml").display().to_string();
    assert_eq!(modulus(&[format!("include=[\"{steel}\"]"), other]), 30e6);
}

/// A table that a scene and its file both have holds the keys of both: a scene adds to a material
/// what its file does not have, and may repeat what it has.
#[test]
fn keys_of_a_scene_and_of_its_file_join() {
    let own = SCENE.replace(
        "[run]",
        "[bonds.cake]\npoisson_ratio = 0.3\ndamping = { damping_ratio = 0.1 }\nfailure = { weibull_modulus = 8, shear_strength = 1e5 }\n[contacts]\ncake-cake = { rolling_friction = 0.1 }\n[run]",
    );
    let folder = Folder::new(&[("scene.toml", &own), ("cake.toml", CAKE)]);
    let scene = folder.read(&[]).unwrap();
    let whole = SCENE
        .replace("include = [\"cake.toml\"]\n", CAKE_FIRST)
        .replace(
            "failure = {",
            "damping = { damping_ratio = 0.1 }, failure = { weibull_modulus = 8,",
        )
        .replace("friction = 0.5", "friction = 0.5, rolling_friction = 0.1");
    let whole = scene_from_text(&whole, "s", &[]).unwrap();
    assert_eq!(scene.bonds, whole.bonds);
    assert_eq!(scene.contacts, whole.contacts);
    assert_eq!(scene.materials, whole.materials);
    // A pair of materials in the other order is the same pair.
    let of_two = "[materials.fine-steel]\nyoung_modulus = 1e9\n[contacts]\nfine-steel-cake = { friction = 0.5 }\n[run]";
    let two = SCENE.replace("[run]", of_two);
    let file = CAKE.replace("[bonds", "cake-fine-steel = { restitution = 0.2 }\n[bonds");
    let folder = Folder::new(&[("scene.toml", &two), ("cake.toml", &file)]);
    assert_eq!(folder.read(&[]).unwrap().contacts.len(), 2);
    let name = folder.path("found.toml").display().to_string();
    let found = "[contacts]\ncake-fine-steel = { friction = 0.7 }\n";
    fs::write(folder.path("found.toml"), found).unwrap();
    let scene = folder.read(&[include_text(&[name])]).unwrap();
    assert!(
        scene.notes[0].contains("friction = 0.5 to 0.7"),
        "{:?}",
        scene.notes
    );
    // A file twice adds nothing.
    let twice = own.replace("[\"cake.toml\"]", "[\"cake.toml\", \"cake.toml\"]");
    let folder = Folder::new(&[("scene.toml", &twice), ("cake.toml", CAKE)]);
    assert_eq!(folder.read(&[]).unwrap().bonds, whole.bonds);
}

#[test]
fn what_cannot_be_included_is_refused_at_its_place() {
    let refused = |scene: &str, cake: &str, wanted: &str| {
        let folder = Folder::new(&[("scene.toml", scene), ("cake.toml", cake)]);
        let said = folder.read(&[]).expect_err(wanted).to_string();
        let said = said.replace(&format!("{}/", folder.0.path().display()), "");
        assert!(said.starts_with(wanted), "{said}\nnot\n{wanted}");
    };
    refused(
        &SCENE.replace(
            "[run]",
            "[bonds.cake]\nyoung_modulus = 1\npoisson_ratio = 0.3\n[run]",
        ),
        CAKE,
        "scene.toml:4: bonds.cake.young_modulus = 1 here, and \"15 MPa\" there (cake.toml:8); remove one of them",
    );
    refused(
        &SCENE.replace(
            "[run]",
            "[bonds.cake.failure]\nvon_mises_strength = 1\n[run]",
        ),
        CAKE,
        "scene.toml:3: bonds.cake.failure has von_mises_strength here, and tensile_strength, shear_strength there (cake.toml:10)",
    );
    refused(
        &SCENE.replace("[run]", "[contacts]\ncake-cake.law = \"linear\"\n[run]"),
        CAKE,
        "scene.toml:4: contacts.cake-cake has another law (cake.toml:6)",
    );
    refused(
        SCENE,
        "[run]\n",
        "cake.toml:1: [run] is in an included file, which may only have [materials], [contacts], [bonds]",
    );
    refused(
        SCENE,
        "materials = 3\n",
        "cake.toml:1: materials is not a table",
    );
    refused(SCENE, "[materials.cake\n", "cake.toml:1: not TOML");
    refused(
        SCENE,
        &CAKE.replace("2050", "\"heavy\""),
        "cake.toml:2: materials.cake.density",
    );
    refused(
        &SCENE.replace("cake.toml", "none.toml"),
        CAKE,
        "none.toml: there is no such file",
    );
    refused(
        &SCENE.replace("[\"cake.toml\"]", "\"cake.toml\""),
        CAKE,
        "scene.toml:2: include is",
    );
}

/// The tables of a scene as text are those tables again, with the values that were set.
#[test]
fn a_scene_gives_a_material_file() {
    let folder = Folder::new(&[("scene.toml", SCENE), ("cake.toml", CAKE)]);
    let source = folder.path("scene.toml").display().to_string();
    let set = set_text("bonds.cake.young_modulus", 12.5, "MPa");
    assert_eq!(set, "bonds.cake.young_modulus=\"12.5 MPa\"");
    let text = material_text(SCENE, &source, &[set]).unwrap();
    let again = Folder::new(&[("scene.toml", SCENE), ("cake.toml", &text)]);
    let (first, second) = (folder.read(&[]).unwrap(), again.read(&[]).unwrap());
    assert_eq!(second.bonds["cake"].young_modulus_pa, 12.5e6);
    assert_eq!(first.materials, second.materials);
    assert_eq!(first.contacts, second.contacts);
    assert_eq!(first.bonds["cake"].failure, second.bonds["cake"].failure);

    let value = |path: &str| written_value(SCENE, &source, &[], path);
    assert_eq!(
        value("bonds.cake.young_modulus").unwrap(),
        Some((15.0, "MPa".to_owned()))
    );
    let shear = value("bonds.cake.failure.shear_strength").unwrap();
    assert_eq!(shear, Some((1e5, String::new())));
    assert_eq!(value("bonds.cake.damping.damping_ratio").unwrap(), None);
    let said = value("bodies.cake.material")
        .expect_err("a name")
        .to_string();
    assert!(
        said.contains("bodies.cake.material is not a number"),
        "{said}"
    );
    let missing = scene_from_text(SCENE, "nowhere/scene.toml", &[]);
    assert!(missing.expect_err("no file").place.contains("cake.toml"));
    assert!(!Path::new("nowhere").exists());
}
