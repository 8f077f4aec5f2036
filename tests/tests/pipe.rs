//! Bodies piped from dem-pack into dem-run.

use std::process::Stdio;

use dem_testing::{names_in, piped};

use super::{dem_pack, dem_run, root};

#[test]
fn dem_run_describes_a_packed_body() {
    let shape = root().join("data/shapes/tablet.stl");
    let packed = dem_pack()
        .arg(shape)
        .args([
            "--diameter",
            "1mm..1.2mm",
            "--particle-density",
            "2050",
            "-q",
        ])
        .output()
        .unwrap();
    assert!(packed.status.success() && packed.stderr.is_empty());
    let body = dem_io::body::vtp::read(&mut &packed.stdout[..]).unwrap();
    let [particles, bonds] = [body.radii.len(), body.bonds.len()];
    let output = piped(dem_run().args(["--body", "-"]), &packed.stdout);
    assert!(output.status.success() && output.stderr.is_empty());
    let said = String::from_utf8(output.stdout).unwrap();
    assert!(
        said.contains(&format!("particles  {particles},"))
            && said.contains(&format!("bonds      {bonds},")),
        "{said}"
    );
    assert!(
        said.contains("2050 kg/m3") && said.contains("seed 1"),
        "{said}"
    );
}

#[test]
fn a_packed_sample_through_a_pipe() {
    let folder = tempfile::tempdir().unwrap();
    let mut pack = dem_pack()
        .arg(root().join("data/shapes/bending-sample.stl"))
        .args(["--diameter", "7mm..9mm", "--quiet"])
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    let output = dem_run()
        .current_dir(folder.path())
        .arg(root().join("data/scenes/clamped.toml"))
        .args(["--body", "-", "--set", "run.end_time=1 ms"])
        .stdin(pack.stdout.take().unwrap())
        .output()
        .unwrap();
    assert!(pack.wait().unwrap().success());
    let said = String::from_utf8(output.stdout).unwrap();
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    assert!(
        said.contains("end_deflection") && said.contains("-> clamped-out"),
        "{said}"
    );
    assert!(
        names_in(&folder.path().join("clamped-out/plots"))
            .contains(&"end_deflection.svg".to_owned())
    );
}
