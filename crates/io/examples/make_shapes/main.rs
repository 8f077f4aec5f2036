//! Writes the example shapes of `data/shapes`:
//! `cargo run --release -p dem-io --example make_shapes -- data/shapes`.

mod shapes;

use std::io::Error;
use std::path::Path;

fn main() -> Result<(), Error> {
    let Some(folder) = std::env::args_os().nth(1) else {
        return Err(Error::other(
            "name the folder to write to: make_shapes FOLDER",
        ));
    };
    shapes::write_all(Path::new(&folder))
}
