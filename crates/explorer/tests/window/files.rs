//! Tests of files: saved, opened, dropped, pasted and invalid ones.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::sync_channel;

use egui::{Key, Modifiers};
use egui_kittest::kittest::Queryable as _;
use kinefront_explorer::{DesignOrigin, Explorer, FrontEntry, InitialContent, Phase, Purpose, open};
use kinefront_export::Format;
use kinefront_model::evaluation::Quantity;
use kinefront_recording::{Recorder, RunFiles, read_run};
use kinefront_study::{Column, RunControl, RunWriter, StudySearch, spawn_search};
use kinefront_testkit::{python, run_folder};

use super::support::{
    Window, act, assert_error, change_study, click, content, copied_text, idle_window, opened_window, press,
    press_with, selected, selected_id, small_study, until, window,
};

/// Returns a window with a finished run.
fn finished() -> Window {
    let mut window = window(content(small_study(), true));
    until(&mut window, "the run ends", |explorer| {
        matches!(explorer.session().phase(), Phase::Finished(_))
            && explorer.session().known().is_some_and(|k| k.verified)
    });
    window
}

/// Types a path into the field for paths.
fn give_path(window: &mut Window, path: &Path) {
    // The field has the focus without a click.
    window.run_steps(3);
    window.key_press_modifiers(Modifiers::COMMAND, Key::A);
    window.get_by_label("Path").type_text(&path.display().to_string());
    window.run_steps(2);
    click(window, "OK");
    until(window, "the file is written", |explorer| !explorer.is_busy());
}

/// As long as a dialog asks, no key acts on what is behind it.
#[test]
fn a_dialog_has_the_keyboard() {
    let mut window = finished();
    press_with(&mut window, Modifiers::COMMAND, Key::S);
    let before = window.state().session().document().selected.clone();
    // Neither in its field nor beside it.
    for key in [Key::ArrowRight, Key::Tab, Key::ArrowRight, Key::K] {
        press(&mut window, key);
    }
    assert_eq!(window.state().session().document().selected, before);
    assert!(window.query_by_label("Path").is_some());
    press(&mut window, Key::Escape);
    assert!(window.query_by_label("Path").is_none());
    press(&mut window, Key::ArrowRight);
    assert_ne!(window.state().session().document().selected, before);
}

#[test]
fn a_recording_is_saved_and_read_back() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = finished();
    let path = folder.path().join("session.rrd");
    window.key_press_modifiers(Modifiers::COMMAND, Key::S);
    give_path(&mut window, &path);
    assert!(path.exists(), "{:?}", window.state().session().notices());

    let recorded = read_run(&path).expect("a recording of Kinefront");
    assert_eq!(recorded.designs.len(), 300);
    let store = window.state().session().store();
    for (id, design) in recorded.designs.iter().enumerate() {
        let row = store.row(id).expect("a row");
        assert_eq!(design.numbers["mass_kg"], row.mass());
        assert_eq!(design.numbers["workspace_radius_m"], row.workspace_radius());
        assert_eq!(design.generation, row.generation as usize);
    }
    // The recording is also read by an independent program.
    if let Some(mut python) = python(&["rerun.experimental"]) {
        let script = "import json, pathlib, subprocess, sys, rerun\n\
            command = pathlib.Path(rerun.__file__).parent.parent / 'rerun_cli' / 'rerun'\n\
            done = subprocess.run([str(command), 'rrd', 'verify', sys.argv[1]], capture_output=True, text=True)\n\
            assert done.returncode == 0 and '1 file verified without error' in done.stderr, done.stderr\n\
            from rerun.experimental import RrdReader\n\
            rows = {}\n\
            for chunk in RrdReader(sys.argv[1]).stream():\n\
            \x20   name = str(chunk.entity_path)\n\
            \x20   rows[name] = rows.get(name, 0) + chunk.to_record_batch().num_rows\n\
            print(rows['/designs'], rows['/card'])\n";
        let output = python.arg("-c").arg(script).arg(&path).output().expect("Python runs");
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let text = String::from_utf8_lossy(&output.stdout).into_owned();
        let counts: Vec<usize> = text
            .split_whitespace()
            .map(|word| word.parse().expect("a count"))
            .collect();
        // There is a card for each design of the front, one for the knee, and one for the selected design.
        assert_eq!(counts, [300, window.state().session().front().len() + 2]);
    }

    // The recording can be opened in the window again.
    let opened = open(&path).expect("opens");
    assert_eq!(opened.store.len(), 300);
    assert_eq!(opened.study, small_study());
    assert!(!opened.front.is_empty());
}

#[test]
fn a_run_folder_is_saved_and_opened_to_the_same() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = finished();
    let path = folder.path().join("run");
    act(&mut window, Purpose::SaveRun, &path);
    for file in ["study.toml", "designs.csv", "front.csv", "run.json", "recording.rrd"] {
        assert!(
            path.join(file).exists(),
            "{file}: {:?}",
            window.state().session().notices()
        );
    }
    let opened = open(&path).expect("opens");
    let session = window.state().session();
    // A table holds no evaluations.
    let shown = session.front().iter().map(|entry| FrontEntry {
        evaluation: None,
        ..entry.clone()
    });
    assert!(shown.eq(opened.front), "the front is opened to the same");
    assert_eq!(opened.history.len(), session.generations().len());
    for (read, told) in opened.history.iter().zip(session.generations()) {
        assert_eq!((read.evaluations, read.front_size), (told.evaluations, told.front_size));
        // Reading JSON may change the last bit.
        assert!((read.hypervolume - told.hypervolume).abs() <= 1e-12 * told.hypervolume);
    }
    assert_eq!(opened.store.len(), session.store().len());
    for id in 0..opened.store.len() {
        assert_eq!(opened.store.row(id), session.store().row(id));
    }
    // A folder that contains a run is not overwritten.
    act(&mut window, Purpose::SaveRun, &path);
    assert_error(&window, "already exists");
}

#[test]
fn the_front_is_exported_with_stars_and_notes() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("front.csv");
    let mut window = opened_window();
    press(&mut window, Key::S);
    act(&mut window, Purpose::ExportFront, &path);
    let mut reader = csv::Reader::from_path(&path).expect("a table");
    let header = reader.headers().expect("a header").clone();
    assert_eq!(
        header.iter().take(13).collect::<Vec<_>>(),
        kinefront_study::Column::common()
            .map(|column| column.name())
            .collect::<Vec<_>>()
    );
    let starred = header.iter().position(|title| title == "starred").expect("starred");
    let rows: Vec<csv::StringRecord> = reader.records().map(|record| record.expect("a row")).collect();
    assert_eq!(rows.len(), window.state().session().front().len());
    let stars: Vec<&csv::StringRecord> = rows.iter().filter(|row| &row[starred] == "true").collect();
    assert_eq!(stars.len(), 1);
    assert_eq!(stars[0][0], selected_id(&window).to_string());
}

/// The selected design is exported in every format, and the front as Parquet: the files are complete and begin
/// correctly.
#[test]
fn the_design_is_exported_for_other_programs() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = opened_window();
    let begins = |format: Format| match format.key() {
        "gltf" => "glTF",
        "mjcf" | "sdf" | "urdf" => "<?xml",
        "dxf" => "  0",
        "json" => "{",
        "csv-parts" => "part,section,",
        "step" => "ISO-10303-21;",
        // The study of the run states no motion.
        "csv-trajectory" => "",
        other => panic!("how does {other} begin?"),
    };
    for &format in Format::ALL {
        let path = folder.path().join(format!("{}.{}", format.key(), format.extension()));
        act(&mut window, Purpose::ExportDesign(format), &path);
        if format.key() == "csv-trajectory" {
            assert_error(&window, "defines no motion");
            assert!(!path.exists());
            continue;
        }
        let bytes = std::fs::read(&path).expect("an export");
        assert!(bytes.starts_with(begins(format).as_bytes()), "{format:?}");
    }
    let report = folder.path().join("report");
    act(&mut window, Purpose::Report, &report);
    let page = std::fs::read_to_string(report.join("index.html")).expect("a page");
    assert!(page.contains("Comparison of the architectures"));
    let front = folder.path().join("front.parquet");
    act(&mut window, Purpose::ExportFront, &front);
    let bytes = std::fs::read(&front).expect("a table");
    assert!(bytes.starts_with(b"PAR1") && bytes.ends_with(b"PAR1"));
}

#[test]
fn a_design_is_copied_and_pasted_as_text() {
    let mut window = opened_window();
    let design = selected(&window).design;
    window.event(egui::Event::Copy);
    window.step();
    assert_eq!(copied_text(&window), Some(design.to_string()));
    window.event(egui::Event::Paste("3-RPR R=2 r=0.5 Lb=2 rj=0.03 rp=0.04".to_owned()));
    window.run_steps(2);
    let pasted = selected(&window);
    assert_eq!(pasted.origin, DesignOrigin::Modified { from: None });
    assert_eq!(pasted.design.architecture().name(), "3-RPR");
    window.event(egui::Event::Paste("3-RPR R=two".to_owned()));
    window.run_steps(2);
    assert_error(&window, "`two` is not a number");
    assert_eq!(selected(&window), pasted);
}

#[derive(Debug)]
struct Dropped(PathBuf);

impl egui::DroppedFile for Dropped {
    fn path(&self) -> &std::path::Path {
        &self.0
    }

    fn bytes(&self) -> Result<Vec<u8>, String> {
        std::fs::read(&self.0).map_err(|error| error.to_string())
    }
}

#[test]
fn files_are_dropped_and_wrong_ones_told() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = idle_window();
    let drop_file = |window: &mut Window, path: PathBuf| {
        window.input_mut().dropped_files.push(Arc::new(Dropped(path)));
        window.run_steps(3);
    };
    drop_file(&mut window, run_folder().join("designs.csv"));
    assert!(matches!(window.state().session().phase(), Phase::Opened(_)));
    assert!(!window.state().session().front().is_empty());
    let designs = window.state().session().store().len();

    let wrong = folder.path().join("wrong.toml");
    std::fs::write(&wrong, "[bounds]\nR_m = [4, 0.5]\n").expect("a file");
    let cut = folder.path().join("cut.rrd");
    std::fs::write(&cut, b"RRF2 and then nothing").expect("a file");
    for (path, words) in [
        (wrong, "bounds.R_m"),
        (cut, "not a recording of a run"),
        (folder.path().join("none"), "is not a run"),
    ] {
        drop_file(&mut window, path);
        assert_error(&window, words);
    }
    // The run that was open before is unchanged.
    assert_eq!(window.state().session().store().len(), designs);
}

#[test]
fn layout_axes_and_recent_files_are_remembered() {
    #[derive(Default)]
    struct Memory(std::collections::BTreeMap<String, String>);
    impl eframe::Storage for Memory {
        fn get_string(&self, key: &str) -> Option<String> {
            self.0.get(key).cloned()
        }
        fn set_string(&mut self, key: &str, value: String) {
            self.0.insert(key.to_owned(), value);
        }
        fn remove_string(&mut self, key: &str) {
            self.0.remove(key);
        }
        fn flush(&mut self) {}
    }
    let mut memory = Memory::default();
    let mut window = idle_window();
    act(&mut window, Purpose::OpenFolder, &run_folder());
    let axes = kinefront_explorer::axes(
        Column::Quantity(Quantity::WorkspaceRadius),
        Column::Quantity(Quantity::Mass),
        true,
    );
    window.state_mut().set_axes(axes);
    eframe::App::save(window.state_mut(), &mut memory);
    assert!(!memory.0.is_empty());
    let memory: &'static Memory = Box::leak(Box::new(memory));
    let again = egui_kittest::Harness::builder().build_eframe(move |cc| {
        cc.storage = Some(memory);
        Explorer::new(cc, content(small_study(), false), None, false).expect("a window")
    });
    assert_eq!(again.state().scatter_axes(), axes);
    assert_eq!(again.state().recent(), [run_folder()]);
}

/// Performs the small study with a budget without a window.
fn perform(evaluations: usize, folder: &Path) {
    let mut study = small_study();
    study.optimizer.evaluations = evaluations;
    let search = StudySearch::new(study, None).expect("a search");
    let writer = RunWriter::create(folder, search.study(), Some(1)).expect("a folder");
    let recorder = Recorder::create(&writer.recording_path(), search.study(), 1).expect("a recording");
    let control = Arc::new(RunControl::default());
    let (next, events) = sync_channel(64);
    let (listeners, files) = RunFiles::start(writer, Some(recorder), next, Arc::clone(&control), |error| {
        panic!("{error}")
    })
    .expect("threads");
    let worker = spawn_search(search, control, listeners).expect("a thread");
    events.into_iter().for_each(drop);
    worker.join().expect("the worker ends");
    assert!(files.join().is_empty());
}

/// A run folder that is opened can be continued where it lies, and leaves what one run of the larger budget leaves.
#[test]
fn an_opened_run_continues_in_its_folder() {
    let folder = tempfile::tempdir().expect("a folder");
    let [whole, run] = ["whole", "run"].map(|name| folder.path().join(name));
    perform(240, &whole);
    perform(100, &run);
    let mut window = window(InitialContent::Run(run.clone()));
    window.run_steps(3);
    click(&mut window, "▶ Continue");
    let notices = window.state().session().notices();
    assert!(
        notices.iter().any(|notice| notice.text.contains("the run is complete")),
        "{notices:?}"
    );

    change_study(&mut window, |study| study.optimizer.evaluations = 240);
    window.run_steps(2);
    window.get_by_label("▶ Continue").click();
    until(&mut window, "the run ends", |explorer| {
        matches!(explorer.session().phase(), Phase::Finished(_))
    });
    assert_eq!(window.state().session().store().len(), 240);
    until(&mut window, "the files are complete", |_| {
        !run.join("progress.json").exists()
    });
    for file in ["study.toml", "designs.csv", "front.csv"] {
        let [found, expected] = [&run, &whole].map(|run| std::fs::read(run.join(file)).expect("a table"));
        assert!(found == expected, "{file}");
    }
}
