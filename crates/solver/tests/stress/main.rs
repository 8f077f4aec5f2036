//! The stress suite.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stderr,
    reason = "a test stops where it fails, and says what it measured"
)]

use std::sync::atomic::AtomicBool;

use dem_run::stress::cases::CASES;
use dem_run::stress::verdict::try_case;

#[test]
fn look() {
    for case in CASES {
        let result = try_case(&case, &AtomicBool::new(false)).unwrap();
        eprintln!("== {} {:.2} s", result.name, result.wall_s);
        for m in result.members {
            if m.wrong.is_some() || std::env::var("ALL").is_ok() { eprintln!("{:40} {:.3} {:?}\n      {:?}\n      {:?}", m.what, m.deviation, m.wrong, m.predicted, m.observed); } else { eprintln!("{:40} {:.3}", m.what, m.deviation); }
        }
    }
}
