//! Pictures read by somebody else: `pngcheck` and Chromium, where they are found.

use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::OnceLock;

/// Asserts that `pngcheck` finds no fault in a PNG or APNG; where it is not installed, a line says so.
#[track_caller]
pub(crate) fn agrees(png: &[u8]) {
    static FOUND: OnceLock<bool> = OnceLock::new();
    let found = *FOUND.get_or_init(|| {
        let found = Command::new("pngcheck")
            .stdin(Stdio::null())
            .output()
            .is_ok();
        if !found {
            println!("skipped: no pngcheck here to read the pictures a second time");
        }
        found
    });
    if !found {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("picture.png");
    std::fs::write(&path, png).expect("room");
    let read = Command::new("pngcheck").arg("-v").arg(&path).output();
    let read = read.expect("it was there before");
    let said = String::from_utf8_lossy(&read.stdout);
    assert!(read.status.success(), "{said}");
}

/// What Chromium shows of a page once its scripts are done, or `None` with a line that says why it was not asked.
pub(crate) fn browse(page: &Path) -> Option<String> {
    for browser in ["chromium", "chromium-browser", "google-chrome"] {
        let profile = tempfile::tempdir().expect("a folder");
        let shown = Command::new(browser)
            .args([
                "--headless",
                "--no-sandbox",
                "--disable-gpu",
                "--disable-dev-shm-usage",
            ])
            .arg(format!("--user-data-dir={}", profile.path().display()))
            .args(["--virtual-time-budget=10000", "--dump-dom"])
            .arg(format!("file://{}", page.display()))
            .stderr(Stdio::null())
            .output();
        if let Ok(shown) = shown {
            return Some(String::from_utf8_lossy(&shown.stdout).into_owned());
        }
    }
    println!("skipped: no Chromium here to show the animation");
    None
}
