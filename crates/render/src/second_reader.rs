//! Pictures read by other programs: `pngcheck` and Chromium, where they are found.

use std::io::{BufRead, BufReader, Read, Write};
use std::net::{TcpListener, TcpStream};
use std::process::{Child, Command, Stdio};
use std::sync::OnceLock;
use std::time::Duration;

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

/// What a page sends back from Chromium by `fetch("/", {method: "POST", body})`, or `None` with a line that says why it
/// was not asked.
pub(crate) fn browse(page: &str) -> Option<String> {
    let listener = TcpListener::bind("127.0.0.1:0").expect("a port of this machine");
    let address = listener.local_addr().expect("it has one");
    let profile = tempfile::tempdir().expect("a folder");
    let start = |browser: &&str| {
        Command::new(browser)
            .args([
                "--headless",
                "--no-sandbox",
                "--disable-gpu",
                "--disable-dev-shm-usage",
            ])
            .arg(format!("--user-data-dir={}", profile.path().display()))
            .args(["--remote-debugging-port=0", &format!("http://{address}/")])
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .ok()
    };
    let browsers = ["chromium", "chromium-browser", "google-chrome"];
    let Some(mut browser) = browsers.iter().find_map(start) else {
        println!("skipped: no Chromium here to show the animation");
        return None;
    };
    let answer = serve(&listener, page, &mut browser);
    // It may have ended by itself.
    let _ended = browser.kill();
    let _waited = browser.wait();
    if answer.is_none() {
        println!("skipped: Chromium ended before it asked for the animation");
    }
    answer
}

/// Hands out the page until something comes back; `None` if the browser ends before it asks for the page.
fn serve(listener: &TcpListener, page: &str, browser: &mut Child) -> Option<String> {
    /// Two minutes of patience.
    const LOOKS: u32 = 6000;
    listener.set_nonblocking(true).expect("it can wait");
    let mut asked = false;
    for _ in 0..LOOKS {
        let Ok((mut stream, _)) = listener.accept() else {
            if !asked && matches!(browser.try_wait(), Ok(Some(_))) {
                return None;
            }
            std::thread::sleep(Duration::from_millis(20));
            continue;
        };
        stream.set_nonblocking(false).expect("it can wait");
        let (head, body) = request(&mut stream);
        let found = head.starts_with("GET / ");
        asked |= found;
        let (status, content) = match found || head.starts_with("POST") {
            true => ("200 OK", if found { page } else { "" }),
            false => ("404 Not Found", ""),
        };
        let reply = format!(
            "HTTP/1.1 {status}\r\nContent-Type: text/html\r\nContent-Length: {}\r\nConnection: close\r\n\r\n{content}",
            content.len()
        );
        // A browser that hung up asks again.
        let _sent = stream.write_all(reply.as_bytes());
        if head.starts_with("POST") {
            return Some(body);
        }
    }
    panic!("Chromium never answered");
}

/// Head and body of a request; empty if the browser hung up.
fn request(stream: &mut TcpStream) -> (String, String) {
    let mut reader = BufReader::new(stream);
    let (mut head, mut length) = (String::new(), 0);
    loop {
        let mut line = String::new();
        if reader.read_line(&mut line).is_err() || line.trim().is_empty() {
            break;
        }
        if let Some(number) = line.to_ascii_lowercase().strip_prefix("content-length:") {
            length = number.trim().parse().unwrap_or(0);
        }
        head.push_str(&line);
    }
    let mut body = vec![0; length];
    let whole = reader.read_exact(&mut body).is_ok();
    (
        head,
        if whole {
            String::from_utf8_lossy(&body).into_owned()
        } else {
            String::new()
        },
    )
}
