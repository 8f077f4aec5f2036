//! The page of a sweep in a real browser: its text is legible. Without an installed Chromium the
//! test is skipped.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use super::{Bench, root};

fn chromium() -> Option<PathBuf> {
    let names = ["chromium", "chromium-browser", "google-chrome"];
    let folders: Vec<PathBuf> = std::env::split_paths(&std::env::var_os("PATH")?).collect();
    let all = names
        .iter()
        .flat_map(|name| folders.iter().map(move |folder| folder.join(name)));
    all.into_iter().find(|path| path.is_file())
}

fn look(chromium: &Path, home: &Path, options: &[&str], page: &Path) -> String {
    let output = Command::new(chromium)
        .args([
            "--headless",
            "--no-sandbox",
            "--disable-gpu",
            "--hide-scrollbars",
        ])
        .args(["--window-size=1100,1800", "--virtual-time-budget=2000"])
        .arg(format!("--user-data-dir={}", home.display()))
        .args(options)
        .arg(format!("file://{}", page.display()))
        .output()
        .unwrap();
    assert!(output.status.success(), "{output:?}");
    String::from_utf8(output.stdout).unwrap()
}

/// Writes problems of the words of the plots into the page (too small, outside the plot,
/// overlapping) and their number.
const INSPECT: &str = "<script>
const wrong = [];
let words = 0;
for (const svg of document.querySelectorAll('svg')) {
  const frame = svg.getBoundingClientRect();
  const boxes = [];
  for (const text of svg.querySelectorAll('text')) {
    const box = text.getBoundingClientRect();
    if (box.width === 0) continue;
    words += 1;
    const said = text.textContent;
    if (parseFloat(getComputedStyle(text).fontSize) < 9) wrong.push('small: ' + said);
    if (box.left < frame.left - 1 || box.right > frame.right + 1 || box.top < frame.top - 1 || box.bottom > frame.bottom + 1)
      wrong.push('outside: ' + said);
    for (const [other, name] of boxes) {
      const x = Math.min(box.right, other.right) - Math.max(box.left, other.left);
      const y = Math.min(box.bottom, other.bottom) - Math.max(box.top, other.top);
      if (x > 2 && y > 4) wrong.push('over each other: ' + said + ' and ' + name);
    }
    boxes.push([box, said]);
  }
}
const requests = performance.getEntriesByType('resource').map(entry => entry.name);
const report = document.createElement('pre');
report.id = 'report';
report.textContent = JSON.stringify({ words, wrong, requests });
document.body.append(report);
</script>";

#[test]
fn the_page_of_a_sweep_can_be_read() {
    let Some(chromium) = chromium() else {
        return;
    };
    let bench = Bench::new();
    for study in ["cantilever-sizes.toml", "spinning-bar.toml"] {
        let study = root().join("data/studies").join(study);
        let output = super::dem_run()
            .current_dir(bench.path(""))
            .arg("sweep")
            .arg(study)
            .args(["--quiet", "--force", "--output", "swept"])
            .output()
            .unwrap();
        assert!(output.status.success(), "{output:?}");
        let page = fs::read_to_string(bench.path("swept/sweep.html")).unwrap();
        let inspected = bench.write(
            "page.html",
            page.replace("</body>", &format!("{INSPECT}</body>")),
        );
        let home = bench.path("home");
        let seen = look(&chromium, &home, &["--dump-dom"], &inspected);
        let report = seen
            .split("<pre id=\"report\">")
            .nth(1)
            .expect("the page was inspected");
        let report = report.split("</pre>").next().unwrap();
        let report: serde_json::Value =
            serde_json::from_str(&report.replace("&amp;", "&")).unwrap();
        assert!(report["words"].as_u64().unwrap() > 15, "{report}");
        assert_eq!(report["wrong"], serde_json::json!([]));
        assert_eq!(report["requests"], serde_json::json!([]));
        let picture = bench.path("page.png");
        let shot = format!("--screenshot={}", picture.display());
        look(&chromium, &home, &[&shot], &bench.path("swept/sweep.html"));
        // White background, dark words, and the colours of the series.
        assert!(colours(&picture) > 50);
    }
}

fn colours(picture: &Path) -> usize {
    let file = std::io::BufReader::new(fs::File::open(picture).unwrap());
    let mut reader = png::Decoder::new(file).read_info().unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut bytes).unwrap();
    let pixels = bytes[..info.buffer_size()].chunks_exact(info.color_type.samples());
    pixels.collect::<BTreeSet<&[u8]>>().len()
}
