//! Tests of the window on a display; Xvfb with a software renderer is sufficient.

use std::io::{BufRead, BufReader};
use std::process::{Child, Command, Stdio};

use predicates::prelude::*;

use super::support::{folder, kinefront, says, small_study};

#[test]
fn without_a_display_the_headless_command_is_named() {
    let mut command = kinefront();
    for name in ["DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET"] {
        command.env_remove(name);
    }
    command
        .arg("explore")
        .assert()
        .code(1)
        .stderr(says("no display").and(says("kinefront optimize")));
}

#[test]
fn what_cannot_be_opened_is_told_before_a_window_is() {
    let folder = folder();
    folder.write("broken.rrd", b"nothing of ours");
    let told = folder.run("explore broken.rrd").code(2);
    told.stderr(says("is not a recording of a run"));
    folder.write("script", "wait finished\ndance\n");
    let told = folder.run("explore --script script").code(2);
    told.stderr(says("line 2").and(says("dance")));
}

/// An X server started by the test, with the name of its display.
struct Display(Child, String);

impl Drop for Display {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// Starts Xvfb on a free display, or prints a message and returns `None` if there is no Xvfb.
fn display() -> Option<Display> {
    let started = Command::new("Xvfb")
        .args(["-displayfd", "1", "-screen", "0", "1600x1000x24"])
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn();
    let mut child = match started {
        Ok(child) => child,
        Err(error) => {
            let message = format!("skipped: no Xvfb ({error}; Debian: xvfb and mesa-vulkan-drivers)");
            assert!(std::env::var_os("KINEFRONT_REQUIRE_DISPLAY").is_none(), "{message}");
            eprintln!("{message}");
            return None;
        }
    };
    let mut line = String::new();
    BufReader::new(child.stdout.take().expect("a pipe"))
        .read_line(&mut line)
        .expect("a display number");
    Some(Display(child, format!(":{}", line.trim())))
}

#[test]
fn the_whole_window_runs_shows_a_design_and_saves() {
    let Some(display) = display() else {
        return;
    };
    let folder = folder();
    let study = small_study(folder.path());
    let [before, after, recording] = ["before.png", "after.png", "session.rrd"].map(|name| folder.join(name));
    let text = format!(
        "wait evaluations 300\nheatmap none\nwait finished\nwait drawn\nwait frames 20\npicture {}\n\
         choose knee\nheatmap inverse_condition\nellipsoids stiffness\nwait drawn\nwait frames 20\npicture {}\nsave {}\nquit\n",
        before.display(),
        after.display(),
        recording.display()
    );
    let script = folder.write("script", text);
    kinefront()
        .env("DISPLAY", &display.1)
        .env_remove("WAYLAND_DISPLAY")
        .env("XDG_RUNTIME_DIR", folder.path())
        .env("XDG_DATA_HOME", folder.path())
        .env("LIBGL_ALWAYS_SOFTWARE", "1")
        .arg("explore")
        .arg(&study)
        .arg("--script")
        .arg(&script)
        .timeout(std::time::Duration::from_secs(240))
        .assert()
        .success();

    let read = |path: &std::path::Path| image::open(path).expect("a picture").to_rgb8();
    let (before, after) = (read(&before), read(&after));
    assert_eq!(before.dimensions(), after.dimensions());
    // The heatmap is the part of the 3-D pane that is green to yellow.
    let green = |picture: &image::RgbImage| {
        let (width, height) = picture.dimensions();
        let pixels = picture.enumerate_pixels().filter(|(x, y, pixel)| {
            let [r, g, b] = pixel.0.map(i32::from);
            (width * 3 / 10..width * 3 / 4).contains(x) && *y < height * 2 / 3 && g > r.min(b) + 40 && g > 90
        });
        pixels.count()
    };
    let (without, with) = (green(&before), green(&after));
    assert!(
        with > 3 * without + 4000,
        "{without} pixels of a heatmap before, {with} after"
    );
    let recorded = kinefront_recording::read_run(&recording).expect("a recording of Kinefront");
    assert_eq!(recorded.designs.len(), 600);
}
