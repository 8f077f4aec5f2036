//! The frames, `frames/frame_000000.vtp` and so on, with their walls.

pub(crate) mod order;
pub(crate) mod walls;

use dem_io::Result;
use dem_results::FrameFiles;

use super::{Changes, Moment, Opening, Output, Saved};
use crate::outputs::frames::order::FrameOrder;
use crate::outputs::frames::walls::WallOutput;

struct Frames {
    files: FrameFiles,
    order: FrameOrder,
    walls: WallOutput,
}

pub(super) fn open(opening: &Opening<'_>) -> Result<Option<Box<dyn Output>>> {
    let (folder, state) = (opening.folder, opening.state);
    let walls = opening.start.walls.clone();
    let files = match opening.position()? {
        None => FrameFiles::create(folder, walls.files()),
        Some(times_s) => FrameFiles::continue_at(folder, walls.files(), times_s)?,
    };
    let order = if opening.continued.is_some() && state.bodies_change() {
        FrameOrder::new(opening.bodies, state)
    } else {
        opening.start.order.clone()
    };
    Ok(Some(Box::new(Frames {
        files,
        order,
        walls,
    })))
}

impl Output for Frames {
    fn write(&mut self, now: &Moment<'_>) -> Result<()> {
        if now.is_frame {
            self.order.write(now.state, &self.walls, &mut self.files)?;
        }
        Ok(())
    }

    fn note_changes(&mut self, changes: &Changes<'_>) -> Result<()> {
        if changes.has_other_bodies {
            self.order = FrameOrder::new(changes.bodies, changes.state);
        }
        Ok(())
    }

    fn save(&self) -> Result<Saved> {
        let times_s = self.files.times_s();
        let files = self.files.files().into_iter();
        Saved::new(&times_s, files.map(|name| (name, None)).collect())
    }
}
