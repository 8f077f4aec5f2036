//! Sheets as test houses write them, and wrong ones.

use dem_io::random::uniform;
use dem_laboratory::drop_weight::fit_ore;

use crate::drop_weight::read;

/// Size, mm, energy, kWh/t, t10, %, t4, %, specimens and broken ones.
const ROWS: [[f64; 6]; 6] = [
    [41.1, 0.1, 6.25, 21.5, 20.0, 12.0],
    [41.1, 0.4, 21.5, 55.25, 20.0, 19.0],
    [41.1, 1.2, 40.0, 81.5, 20.0, 20.0],
    [14.5, 0.25, 8.5, 26.5, 30.0, 21.0],
    [14.5, 1.0, 27.5, 65.0, 30.0, 27.0],
    [14.5, 2.5, 45.0, 86.0, 30.0, 30.0],
];

fn text(head: &str, row: impl Fn([f64; 6]) -> String) -> String {
    let rows: Vec<String> = ROWS.into_iter().map(row).collect();
    format!("{head}\n{}\n", rows.join("\n"))
}

fn comma(value: f64) -> String {
    value.to_string().replace('.', ",")
}

#[test]
fn sheets_of_many_kinds_give_the_same_tests() {
    let plain = text(
        "size (mm),Ecs (kWh/t),t10 (%),t4 (%),specimens,broken",
        |[x, e, t, u, n, k]| format!("{x},{e},{t},{u},{n},{k}"),
    );
    let wanted = read(&[&plain]).unwrap();
    assert_eq!(wanted.tests.len(), 6);
    assert!(wanted.notes.is_empty(), "{:?}", wanted.notes);
    let files = [
        text(
            "Drop weight test 7\nJob;12/3\n\nParticle size;Specific energy;t10 passing;t_4;Particles;Broken\nmm;J/g;%;%;-;%",
            |[x, e, t, u, n, k]| {
                format!(
                    "{};{};{};{};{n};{}",
                    comma(x),
                    comma(3.6 * e),
                    comma(t),
                    comma(u),
                    comma(100.0 * k / n)
                )
            },
        ),
        text(
            "t4\tt10\tbroken (-)\tNumber of specimens (-)\tEnergy [J/kg]\tSize [cm]\tRemark",
            |[x, e, t, u, n, k]| {
                format!(
                    "{}\t{}\t{k}\t{n}\t{}\t{}\tok",
                    u / 100.0,
                    t / 100.0,
                    3600.0 * e,
                    x / 10.0
                )
            },
        ),
        text(
            "size_mm,ecs_kwh_t,t10_pct,t4_pct,n,broken_fraction,ore",
            |[x, e, t, u, n, k]| format!("{x},{e},{t},{u},{n},{},Pit 3", k / n),
        ),
        text(
            "Size from (mm) | Size to (mm) | Ecs / kWh/t | t10 / % | t4 / % | specimens | broken | sample",
            |[x, e, t, u, n, k]| {
                format!(
                    "{} | {} | {e} | {t} | {u} | {n} | {k} | N{}",
                    x * 1.2,
                    x / 1.2,
                    x - e
                )
            },
        ),
        text(
            "Size fraction (mm);Eis (kJ/kg);t10 (-);t4 (-);specimens;broken",
            |[x, e, t, u, n, k]| {
                format!(
                    "-{:.9}+{:.9};{};{};{};{n};{k}",
                    1.25 * x,
                    x / 1.25,
                    3.6 * e,
                    t / 100.0,
                    u / 100.0
                )
            },
        ),
        text(
            "size,Ecs (kWh/t),t10 (%),t4 (%),specimens,broken",
            |[x, e, t, u, n, k]| {
                format!("{:.9} x {:.9} mm,{e},{t},{u},{n},{k}", 1.25 * x, x / 1.25)
            },
        ),
    ];
    for file in &files {
        let found = read(&[file]).unwrap_or_else(|error| panic!("{error}\n{file}"));
        assert_eq!(found.tests.len(), 6, "{file}");
        for (one, other) in found.tests.iter().zip(&wanted.tests) {
            let near = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-8;
            assert!(near(one.size_m, other.size_m), "{one:?}\n{other:?}\n{file}");
            assert!(
                near(one.energy_j_kg, other.energy_j_kg),
                "{one:?}\n{other:?}\n{file}"
            );
            assert!(
                near(one.t10.unwrap(), other.t10.unwrap()),
                "{one:?}\n{other:?}\n{file}"
            );
            assert!(
                near(one.family[0][1], other.family[0][1]),
                "{one:?}\n{other:?}\n{file}"
            );
            let [counts, others] = [one, other].map(|test| test.broken.unwrap());
            assert!(
                near(counts[0], others[0]) && near(counts[1], others[1]),
                "{one:?}\n{file}"
            );
        }
    }
    // A sheet for each size, in other units.
    let lines: Vec<&str> = plain.lines().collect();
    let one = lines[..4].join("\n");
    let other = files[1].lines().collect::<Vec<_>>();
    let other = [&other[..1], &other[4..]].concat().join("\n");
    let joined = read(&[&one, &other]).unwrap();
    assert_eq!(joined.files.len(), 2);
    let [all, parts] = [&wanted, &joined].map(|sheets| fit_ore(sheets).unwrap().law);
    assert!((all.b_kg_j / parts.b_kg_j - 1.0).abs() < 1e-6);
    assert!((all.fracture_energy_j_kg / parts.fracture_energy_j_kg - 1.0).abs() < 1e-6);
}

#[test]
fn wrong_sheets_are_refused_with_one_message() {
    let head = "size (mm),Ecs (kWh/t),t4 (%),t10 (%)";
    let sheet = |rows: &str| format!("{head}\n{}", rows.replace(' ', "\n"));
    let good = sheet("30,0.25,30,10 30,1,60,25 30,2.5,85,45");
    assert!(fit_ore(&read(&[&good]).unwrap()).is_ok());
    let with = |from: &str, to: &str| good.replacen(from, to, 1);
    let cases: Vec<(Vec<String>, &str)> = vec![
        (
            vec![with("30,1,60,25", "30,1,60,125")],
            "1.csv: line 3: the t10 is 125 %, above 100 %; correct or remove this line",
        ),
        (
            vec![
                with("t10 (%)", "t10")
                    .replace("t4 (%)", "t4")
                    .replace("30,10", "30,0.12"),
            ],
            "1.csv: line 2: the t10 is 0.12, that of another line 45: percent and fractions are mixed, or the unit is missing; write all in percent, and the unit behind the name: t10 (%)",
        ),
        (
            vec![with("30,10", "30,0.12")],
            "1.csv: line 2: the t10 is 0.12 %, but t4 30 %: percent and fractions are mixed; write all in percent, or remove this line",
        ),
        (
            vec![with("t10 (%)", "t10 (-)").replace("30,10", "30,0.1")],
            "1.csv: line 3: the t10 is 25, above 1, in a column of fractions: percent and fractions are mixed",
        ),
        (
            vec![with("30,2.5,85,45", "30,2.5,85,9")],
            "1.csv: line 4: the t10 is 9 % at 2.5 kWh/t, but 25 % at 1 kWh/t at 1.csv: line 3: more energy does not make coarser pieces; check both lines for swapped energies, sizes or columns",
        ),
        (
            vec![sheet("30,0.25,85,9.3 30,1,85,4.5 30,2.5,85,45")],
            "1.csv: line 3: the t10 is 4.5 % at 1 kWh/t, but 9.3 % at 0.25 kWh/t at 1.csv: line 2: more energy does not make coarser pieces",
        ),
        (
            vec![sheet("30,0.25,85,45 30,1,85,40 30,2.5,85,36")],
            "1.csv: line 4: the t10 is 36 % at 2.5 kWh/t, but 45 % at 0.25 kWh/t at 1.csv: line 2: in all tests of this size it falls with the energy",
        ),
        (
            vec![with("30,1,60,25", "30,1,20,25")],
            "1.csv: line 3: t10 is 25 %, above t4 with 20 %: less passes a finer sieve; check the order of the columns and the units of this line",
        ),
        (
            vec![with("30,1,60,25", "-30,1,60,25")],
            "1.csv: line 3: the size is -30, not above 0; correct or remove this line",
        ),
        (
            vec![with("30,1,60,25", "30,-1,60,25")],
            "1.csv: line 3: the energy is -3600 J/kg, not above 0; correct or remove this line",
        ),
        (
            vec![with("30,1,60,25", "30,1,60,")],
            "1.csv: line 3: the t10 is missing; write it, or remove this line",
        ),
        (
            vec![with("30,1,60,25", "30,1,60,n/a")],
            "1.csv: line 3: the t10 is 'n/a', not a number",
        ),
        (
            vec![with("Ecs (kWh/t)", "Ecs")],
            "1.csv: the energy 'Ecs' has no unit; write it behind the name, such as Ecs (kWh/t); units are mJ/kg, J/kg, kJ/kg, kWh/t, J/g",
        ),
        (
            vec![with("Ecs (kWh/t)", "Ecs (J)")],
            "1.csv: 'J' is not a unit of 'Ecs'; use one of mJ/kg",
        ),
        (
            vec![with("30,1,60,25", "30,3600,60,25")],
            "1.csv: line 3: the energy is 3600 kWh/t, not between 0.0001 and 100; check the unit of the energy",
        ),
        (
            vec![
                good.clone(),
                good.replace("kWh/t", "J/kg").replace("0.25", "0.5"),
            ],
            "1.csv: line 2: the energy is 900 J/kg, 360 times that of 2.csv: line 4 with none between, at a like t10: they are in two units",
        ),
        (
            vec![
                with("30,0.25,30,10", "30,0.5,30,10\n30,1800,62,26")
                    .replace("kWh/t", "J/kg")
                    .replace("30,1,", "30,3600,")
                    .replace("30,2.5,", "30,9000,"),
            ],
            "1.csv: line 3: the energy is 1800 J/kg, 3600 times that of 1.csv: line 2",
        ),
        (
            vec![
                good.replace("t10 (%)", "t10 (%),ore")
                    .replace("0\n", "0,North\n")
                    .replace("25\n", "25,South\n")
                    .replace(",45", ",45,South"),
            ],
            "1.csv: line 3: the ore is 'South', but 'North' at 1.csv: line 2; fit each ore by itself, from a file of its own",
        ),
        (
            vec![sheet("30,0.25,30,10 30,1,60,25")],
            "1.csv: has no 3 rows with two numbers or more, one below the other; write the names of the columns and at least three rows: size (mm), Ecs (kWh/t), t10 (%)",
        ),
        (
            vec![sheet("30,0.25,30,10 30,1,60,25 60,2.5,85,45")],
            "3 rows with a t10 for 3 numbers (A, b and the size exponent), at least 4 are needed to tell their scatter; add tests, or further sheets of this ore",
        ),
        (
            vec![sheet("30,1,60,25 30,1,60,24 30,1,60,26")],
            "all energies are near 1 kWh/t, within a factor of 1.2: A and b cannot be told apart; add tests at other energies",
        ),
        (
            vec![sheet("30,1,0,0 30,2,0,0 30,4,0,0")],
            "every t10 is 0; test with larger energies",
        ),
        (
            vec![
                good.replace("t4 (%)", "specimens")
                    .replace("t10 (%)", "t10 (%),broken")
                    .replace("10\n", "10,31\n")
                    .replace("25\n", "25,60\n")
                    .replace(",45", ",45,85"),
            ],
            "1.csv: line 2: 31 specimens broke, of 30; correct this line",
        ),
        (
            vec![good.replace("t4 (%)", "broken (%)")],
            "1.csv: there is a column of broken specimens, but none of the number of specimens; add a column: specimens",
        ),
        (
            vec![with("t4", "t10")],
            "1.csv: there are two columns of t10; remove one of them",
        ),
        (
            vec![with("size (mm)", "length (mm)")],
            "1.csv: no column of the size among 'length', 'Ecs', 't4', 't10'; write its name above the numbers: size (mm), or size from (mm) and size to (mm)",
        ),
        (vec![with("t10", "t9")], "1.csv: no column of the t10 among"),
        (
            vec![with("size (mm)", "size").replace("\n30,", "\n0.03,")],
            "1.csv: line 2: the size is 0.03 without a unit, below 0.5 mm; write the unit behind the name: size (m)",
        ),
        (
            vec!["size (mm);Ecs (J/kg);t10 (%)\n30;360;10\n30;900;25\n30;2.500;45".to_owned()],
            "1.csv: line 4: the energy is '2.500', which may be 2.500 or 2500: the file does not show which sign is the decimal one",
        ),
        (
            vec![with("size (mm)", "size (m)")],
            "1.csv: line 2: the size is 30000 mm, not between 0.01 mm and 10000 mm; check the unit of the size",
        ),
        (vec![good.clone(), String::new()], "2.csv: has no 3 rows"),
    ];
    let cases = cases.into_iter().chain([(
        vec![good.replace("t4 (%)", "note").replace("30,10", "30,0.12").replace(",25\n", ",35\n")],
        "1.csv: line 2: the t10 is 0.12 %, but 35 % at 1.csv: line 3: percent and fractions are mixed",
    )]);
    for (texts, wanted) in cases {
        let texts: Vec<&str> = texts.iter().map(String::as_str).collect();
        let error = read(&texts)
            .and_then(|sheets| fit_ore(&sheets))
            .expect_err(wanted);
        assert_eq!(error.exit_code(), 2);
        let said = error.to_string();
        // Places of whole sheets name their folder.
        let said = if wanted.contains("csv") {
            said
        } else {
            said.split_once(": ").unwrap().1.to_owned()
        };
        assert!(
            said.starts_with(wanted),
            "{said}\nnot\n{wanted}\nof\n{}",
            texts.join("\n")
        );
        assert!(!said.contains('\n'), "{said}");
    }
}

/// Sheets with letters and digits exchanged, removed and doubled are read or refused; what is
/// fitted to them is finite.
#[test]
fn damaged_sheets_are_read_or_refused() {
    let whole = text(
        "size (mm),Ecs (kWh/t),t10 (%),t4 (%),specimens,broken",
        |[x, e, t, u, n, k]| format!("{x},{e},{t},{u},{n},{k}"),
    );
    let (mut fitted, mut refused) = (0, 0);
    for seed in 0..400 {
        let mut bytes = whole.clone().into_bytes();
        for change in 0..=(seed % 4) {
            let at = (uniform(seed, &[change, 0]) * bytes.len() as f64) as usize;
            let other = b"0123456789.,;-+e% \n"[(uniform(seed, &[change, 1]) * 19.0) as usize];
            match (uniform(seed, &[change, 2]) * 3.0) as usize {
                0 => bytes[at] = other,
                1 => bytes.insert(at, other),
                _ => drop(bytes.remove(at)),
            }
        }
        let damaged = String::from_utf8(bytes).unwrap();
        match read(&[&damaged]).and_then(|sheets| fit_ore(&sheets)) {
            Ok(ore) => {
                fitted += 1;
                let law = ore.law;
                let numbers = [
                    law.largest_t10,
                    law.b_kg_j,
                    law.fracture_energy_j_kg,
                    law.energy_scatter,
                    law.b_exponent,
                    law.energy_exponent,
                    law.family_exponent,
                    ore.rms,
                ];
                assert!(
                    numbers.iter().all(|number| number.is_finite()),
                    "{law:?}\n{damaged}"
                );
                assert!(
                    law.largest_t10 <= 1.0 && law.b_kg_j > 0.0,
                    "{law:?}\n{damaged}"
                );
            }
            Err(error) => {
                refused += 1;
                assert_eq!(error.exit_code(), 2, "{error}");
                assert!(!error.remedy.is_empty(), "{error}");
            }
        }
    }
    assert!(fitted > 40 && refused > 40, "{fitted} {refused}");
}
