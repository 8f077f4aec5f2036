//! Reads the numbers of a view back from its page, as a browser does.

use std::collections::BTreeMap;
use std::io::Read;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flate2::read::ZlibDecoder;
use serde_json::Value;

/// The data of a view.
pub(crate) struct Read3d {
    pub(crate) head: Value,
    /// Values of each frame, by the name of the track.
    pub(crate) tracks: BTreeMap<String, Vec<Vec<i64>>>,
}

impl Read3d {
    pub(crate) fn of(page: &str) -> Self {
        let head: Value = serde_json::from_str(script(page, "view-head")).unwrap();
        let packed = STANDARD.decode(script(page, "view-data")).unwrap();
        let mut bytes = Vec::new();
        ZlibDecoder::new(packed.as_slice())
            .read_to_end(&mut bytes)
            .unwrap();
        let mut rest = bytes.as_slice();
        let mut tracks = BTreeMap::new();
        for track in head["tracks"].as_array().unwrap() {
            let width = track["bytes"].as_u64().unwrap() as usize;
            let mut frames: Vec<Vec<i64>> = Vec::new();
            for count in track["counts"].as_array().unwrap() {
                let count = count.as_i64().unwrap();
                let last = frames.last().cloned().unwrap_or_default();
                if count < 0 {
                    frames.push(last);
                    continue;
                }
                let (own, after) = rest.split_at(width * count as usize);
                rest = after;
                frames.push(values(own, width, &last));
            }
            tracks.insert(track["name"].as_str().unwrap().to_owned(), frames);
        }
        assert!(rest.is_empty(), "{} bytes too many", rest.len());
        Self { head, tracks }
    }

    /// Places of the spheres of a frame, m.
    pub(crate) fn places_m(&self, frame: usize) -> Vec<[f64; 3]> {
        let unit = self.head["resolution_m"].as_f64().unwrap();
        let of = |axis: &str| &self.tracks[axis][frame];
        let count = of("x").len();
        let place = |i: usize| {
            let steps = [of("x")[i], of("y")[i], of("z")[i]];
            [0, 1, 2].map(|k| self.head["origin_m"][k].as_f64().unwrap() + unit * steps[k] as f64)
        };
        (0..count).map(place).collect()
    }
}

fn values(bytes: &[u8], width: usize, last: &[i64]) -> Vec<i64> {
    let count = bytes.len() / width;
    let modulus = 1_i64 << (8 * width);
    let mut values: Vec<i64> = Vec::new();
    for i in 0..count {
        let difference: i64 = (0..width)
            .map(|plane| i64::from(bytes[plane * count + i]) << (8 * plane))
            .sum();
        let before = if last.len() == count {
            last[i]
        } else {
            values.last().copied().unwrap_or(0)
        };
        values.push((before + difference).rem_euclid(modulus));
    }
    values
}

/// The text of the script of this id.
pub(crate) fn script<'a>(page: &'a str, id: &str) -> &'a str {
    let after = page.split(&format!("<script id=\"{id}\"")).nth(1).unwrap();
    let text = after.split_once('>').unwrap().1;
    text.split("</script>").next().unwrap()
}
