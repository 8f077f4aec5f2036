//! `dem-run picture`: pictures and films of a finished run.

use std::io::Write;
use std::path::PathBuf;

use clap::Args;
use dem_io::safe_write::write_file;
use dem_io::text::visible;
use dem_io::units::{NUMBER, TIME, length_m, quantity};
use dem_io::write_target::need_folder_of;
use dem_io::{Diagnostic, Result};
use dem_report::picture::{ColourBy, PictureKind, PictureOrder, Which, picture};
use dem_report::wall_loads::{WallQuantity, wall_picture};
use dem_terminal::colour::{Colour, on_standard_error};
use dem_terminal::standard_output::write_standard_output;

/// Largest width and height, px, and largest magnification.
const MOST_PX: u32 = 8192;
const MOST_ZOOM: f64 = 1e4;

#[derive(Debug, Args)]
pub(super) struct PictureArguments {
    /// The folder of the run
    folder: PathBuf,
    /// File to write: .png for one frame, .gif for a film of all
    #[arg(long, short, value_name = "FILE")]
    output: PathBuf,
    /// Number of the frame, from 0; the last unless given
    #[arg(long, value_name = "N")]
    frame: Option<usize>,
    /// Time of the frame, such as 3ms: the nearest one is shown
    #[arg(long, value_name = "TIME", conflicts_with = "frame")]
    time: Option<String>,
    /// Direction of the viewer, such as 1,-2,0.5; that of the scene unless given
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true)]
    from: Option<String>,
    /// Place in the middle of the picture, such as 0,0,20mm; plain numbers are metres
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true)]
    target: Option<String>,
    /// Magnification; with 1 everything is in the picture
    #[arg(long, default_value_t = 1.0, value_name = "FACTOR")]
    zoom: f64,
    /// Width and height in pixels
    #[arg(long, default_value = "960x540", value_name = "WIDTHxHEIGHT")]
    size: String,
    /// What colours tell, as output.colour_by of a scene: fragment, fragment_mass, strain_rate,
    /// dynamic_increase_factor or dynamic_utilisation; or body, speed, utilisation or stress
    #[arg(long, default_value = "fragment", value_name = "QUANTITY")]
    colour_by: String,
    /// Instead of a frame the walls with loads, at the end of the run, in colours: wear_depth,
    /// impact, friction or normal_impulse
    #[arg(long, value_name = "QUANTITY", conflicts_with_all = ["frame", "time", "colour_by"])]
    wall_loads: Option<String>,
}

pub(super) fn write_picture(arguments: &PictureArguments) -> Result<()> {
    let target = &arguments.output;
    let name = target.display().to_string();
    let ending = target.extension().unwrap_or_default().to_ascii_lowercase();
    let kind = match ending.to_str() {
        Some("png") => PictureKind::Png,
        Some("gif") if arguments.frame.is_some() || arguments.time.is_some() => {
            let option = if arguments.time.is_some() {
                "--time"
            } else {
                "--frame"
            };
            let problem = "a film shows all frames";
            return Err(Diagnostic::input(
                option,
                problem,
                "write a .png, or leave it out",
            ));
        }
        Some("gif") => PictureKind::Gif,
        _ => {
            let remedy = "end it with .png for one frame, or .gif for a film";
            return Err(Diagnostic::input(
                name,
                "this is not the name of a picture",
                remedy,
            ));
        }
    };
    let order = order(arguments)?;
    need_folder_of(target)?;
    if let Some(by) = &arguments.wall_loads {
        return write_wall_picture(arguments, wall_quantity(by)?, &order, kind);
    }
    let drawn = picture(&arguments.folder, &order, kind)?;
    write_file(target, |out| out.write_all(&drawn.bytes))?;
    let warn = |text: &str| {
        let word = on_standard_error("warning:", Colour::Yellow);
        // A closed output is not a reason to fail: the picture is written.
        let _ = writeln!(std::io::stderr(), "{word} {}: {text}", visible(&name));
    };
    if drawn.is_empty {
        let remedy = match (&arguments.target, arguments.zoom > 1.0) {
            (None, false) => "show another frame, with --frame or --time",
            _ => "leave out --target and --zoom to see everything",
        };
        warn(&format!("no particle is within the picture; {remedy}"));
    }
    if drawn.far_away > 0 {
        warn(&format!(
            "{} spheres are far from the walls, and the picture is not scaled to show them; --zoom 0.5 shows more",
            drawn.far_away
        ));
    }
    write_standard_output(|out| writeln!(out, "{}", visible(&name)))
}

/// Writes the picture of the walls with loads.
fn write_wall_picture(
    arguments: &PictureArguments,
    by: WallQuantity,
    order: &PictureOrder,
    kind: PictureKind,
) -> Result<()> {
    let target = &arguments.output;
    let name = target.display().to_string();
    if kind == PictureKind::Gif {
        let problem = "the loads of walls are those at the end of the run";
        return Err(Diagnostic::input(name, problem, "write a .png"));
    }
    let place = (order.target_m, order.zoom);
    let png = wall_picture(&arguments.folder, by, order.from, place, order.size_px)?;
    write_file(target, |out| out.write_all(&png))?;
    write_standard_output(|out| writeln!(out, "{}", visible(&name)))
}

fn wall_quantity(text: &str) -> Result<WallQuantity> {
    let found = WallQuantity::WORDS.iter().find(|(name, _)| *name == text);
    found.map(|(_, by)| *by).ok_or_else(|| {
        let names = WallQuantity::WORDS.map(|(name, _)| name);
        let problem = format!("'{text}' is no quantity of walls");
        let remedy = format!("write one of {}", names.join(", "));
        Diagnostic::input("--wall-loads", problem, remedy)
    })
}

fn order(arguments: &PictureArguments) -> Result<PictureOrder> {
    if !(arguments.zoom > 0.0 && arguments.zoom <= MOST_ZOOM) {
        let problem = format!("{} is not above 0 and at most {MOST_ZOOM}", arguments.zoom);
        return Err(Diagnostic::input(
            "--zoom",
            problem,
            "2 shows half of the width",
        ));
    }
    let plain = |text: &str| quantity(text, &NUMBER);
    let from = arguments.from.as_deref();
    let from = from.map(|text| three("--from", text, plain)).transpose()?;
    if from == Some([0.0; 3]) {
        let remedy = "1,-2,0.5 looks from the right, the front and above";
        return Err(Diagnostic::input("--from", "this is no direction", remedy));
    }
    let target = arguments.target.as_deref();
    Ok(PictureOrder {
        frame: which(arguments)?,
        from,
        target_m: target
            .map(|text| three("--target", text, length_m))
            .transpose()?,
        zoom: arguments.zoom,
        size_px: size_px(&arguments.size)?,
        colour_by: colour_by(&arguments.colour_by)?,
    })
}

fn which(arguments: &PictureArguments) -> Result<Which> {
    let time = arguments.time.as_deref();
    let time_s = time.map(|text| quantity(text, &TIME)).transpose();
    let time_s = time_s.map_err(|error| error.within("--time"))?;
    Ok(match (time_s, arguments.frame) {
        (Some(time_s), _) => Which::Nearest(time_s),
        (None, Some(number)) => Which::Number(number),
        (None, None) => Which::Last,
    })
}

fn colour_by(text: &str) -> Result<ColourBy> {
    let found = ColourBy::WORDS.iter().find(|(name, _)| *name == text);
    if let Some((_, colour_by)) = found {
        return Ok(*colour_by);
    }
    if text == "mass" {
        let remedy = "write fragment_mass, as in a scene";
        return Err(Diagnostic::input(
            "--colour-by",
            "'mass' has another name",
            remedy,
        ));
    }
    let names = ColourBy::WORDS.map(|(name, _)| name);
    let problem = format!("'{text}' is no quantity of a picture");
    let remedy = format!("write one of {}", names.join(", "));
    Err(Diagnostic::input("--colour-by", problem, remedy))
}

/// Three numbers in SI.
fn three(option: &str, text: &str, of: impl Fn(&str) -> Result<f64>) -> Result<[f64; 3]> {
    let parts = text.split(',').map(|part| of(part.trim()));
    let parts: Vec<f64> = parts
        .collect::<Result<_>>()
        .map_err(|error| error.within(option))?;
    parts.try_into().map_err(|_| {
        let problem = format!("'{text}' is not three numbers");
        Diagnostic::input(option, problem, "write them as X,Y,Z")
    })
}

fn size_px(text: &str) -> Result<[u32; 2]> {
    let sides = text.split_once('x');
    let sides = sides.and_then(|(wide, high)| Some([wide.parse().ok()?, high.parse().ok()?]));
    sides
        .filter(|sides| sides.iter().all(|side| (16..=MOST_PX).contains(side)))
        .ok_or_else(|| {
            let problem = format!("'{text}' is not a width and a height from 16 to {MOST_PX}");
            Diagnostic::input("--size", problem, "write 1920x1080")
        })
}
