//! A script that operates the window as a user would, for pictures, measurements and demonstrations.
//!
//! Each line is a step. Empty lines, lines that begin with `#`, and text from `# ` to the end of a line are ignored:
//!
//! | step | does |
//! |---|---|
//! | `wait finished` | waits for the end of the run |
//! | `wait evaluations N` | waits until N designs are evaluated |
//! | `wait drawn` | waits until the design is verified and everything requested of the scene is drawn |
//! | `wait answered` | waits until every question is answered that panels have asked: prices, wishes, why not |
//! | `wait proved` | waits until the workspace of the selected design is proved |
//! | `wait frames N` | waits N frames |
//! | `choose knee`, `choose #ID`, `choose DESIGN` | selects a design |
//! | `walk N` | moves the selection by N designs along the front |
//! | `pin`, `keep`, `star` | do what the buttons do |
//! | `what-if KEY=VALUE` | changes a dimension \[m\] of the selected design |
//! | `heatmap FIELD`, `ellipsoids KIND` | shows a layer; `none` hides it |
//! | `pose x=… y=… phi_deg=…`, `worst ID` | moves the platform to a pose, or to the worst pose of a constraint |
//! | `violation` | moves the platform to the infeasible pose that ends the proof, and shows the proof |
//! | `show PANEL` | brings a panel to the front, by its title |
//! | `compare on`, `compare off` | shows or hides the pinned designs in 3-D |
//! | `theme dark`, `theme light` | sets the colours |
//! | `look VIEWPOINT` | looks at the manipulator from `oblique`, `top`, `front` or `side` |
//! | `point X Y`, `click X Y` | moves the pointer, and clicks, at a place of the window \[points\] |
//! | `drag X Y X Y …` | presses the button of the mouse at the first place, moves through the others, and releases it at the last |
//! | `tool pan`, `tool box`, `tool lasso` | sets what dragging in the scatter does |
//! | `color architecture`, `color density`, `color KEY` | sets what the colours of the scatter tell |
//! | `size W H` | sets the size of the window \[points\] |
//! | `beside FOLDER` | shows a run beside that in the window |
//! | `pause`, `resume`, `stop` | control the run |
//! | `filter KEY LOW HIGH` | sets a range of the filter |
//! | `picture FILE.png`, `save FILE.rrd` | writes a file and waits until it is written |
//! | `frames FILE.csv` | records the duration of every frame from here on, written at `quit` |
//! | `quit` | closes the window |

use kinefront_study::Column;
use std::path::{Path, PathBuf};
use std::time::Instant;

use egui::{Context, Event, Modifiers, PointerButton, Pos2, ViewportCommand};

use super::Explorer;
use crate::files::Purpose;
use crate::panels::Panel;
use crate::panels::scatter::{Coloring, DragTool};
use crate::{Phase, Session};
use kinefront_model::evaluation::Constraint;
use kinefront_model::mechanism::{DESIGN_VARIABLES, DesignVariable, FURTHER_VARIABLES};
use kinefront_model::spatial::Pose;
use kinefront_recording::Viewpoint;
use kinefront_scene::{EllipsoidKind, Field};

/// A script in progress.
#[derive(Debug)]
pub struct Script {
    /// Remaining steps with their line numbers, in order.
    steps: std::vec::IntoIter<(usize, Step)>,
    current: Option<Step>,
    frames: usize,
    times: Option<(PathBuf, Vec<f64>, Instant)>,
}

#[derive(Debug, Clone)]
enum Step {
    WaitFinished,
    WaitEvaluations(usize),
    WaitDrawn,
    WaitAnswered,
    WaitProved,
    WaitFrames(usize),
    WaitBusy,
    /// Does what a button does.
    Press(fn(&mut Session)),
    Choose(usize),
    ChooseDesign(String),
    Walk(isize),
    Modify(DesignVariable, f64),
    Heatmap(Option<Field>),
    Ellipsoids(Option<EllipsoidKind>),
    Pose(Pose),
    Worst(Constraint),
    Show(Panel),
    Compare(bool),
    Dark(bool),
    Look(Viewpoint),
    Drag(Vec<Pos2>),
    Tool(DragTool),
    Color(Coloring),
    Size(Pos2),
    Point(Pos2),
    Filter(Column, [f64; 2]),
    File(Purpose, PathBuf),
    Frames(PathBuf),
    Quit,
}

/// Why a script cannot be read.
#[derive(Debug, thiserror::Error)]
pub enum ScriptError {
    /// The file cannot be read.
    #[error("cannot read {}: {cause}", path.display())]
    Read {
        /// Path of the file.
        path: PathBuf,
        /// Cause of the failure.
        cause: std::io::Error,
    },
    /// A script file has a line that is not a step.
    #[error("{}, {error}", path.display())]
    File {
        /// Path of the file.
        path: PathBuf,
        /// What is wrong in it.
        error: Box<ScriptError>,
    },
    /// A line is not a step.
    #[error("line {line}: `{text}` is not a script step")]
    Step {
        /// Number of the line, from 1.
        line: usize,
        /// The line.
        text: String,
    },
}

impl Script {
    /// Reads a script.
    ///
    /// # Errors
    /// [`ScriptError::Step`] for the first line that is not a step.
    pub fn parse(text: &str) -> Result<Self, ScriptError> {
        let mut steps = Vec::new();
        for (index, line) in text.lines().enumerate() {
            // A `#` before a digit begins an id; a `#` before a space begins a comment.
            let line = match line.find("# ").or_else(|| line.starts_with('#').then_some(0)) {
                Some(end) => &line[..end],
                None => line,
            };
            let line = line.trim();
            if !line.is_empty() {
                let step = step(line).ok_or_else(|| ScriptError::Step {
                    line: index + 1,
                    text: line.to_owned(),
                })?;
                let file = matches!(step, Step::File(..));
                steps.push((index + 1, step));
                if file {
                    steps.push((index + 1, Step::WaitBusy));
                }
            }
        }
        Ok(Self {
            steps: steps.into_iter(),
            current: None,
            frames: 0,
            times: None,
        })
    }

    /// Reads a script file.
    ///
    /// # Errors
    /// [`ScriptError`] for a file that cannot be read or a line that is not a step.
    pub fn read(path: &Path) -> Result<Self, ScriptError> {
        let text = std::fs::read_to_string(path).map_err(|cause| ScriptError::Read {
            path: path.to_owned(),
            cause,
        })?;
        Self::parse(&text).map_err(|error| ScriptError::File {
            path: path.to_owned(),
            error: Box::new(error),
        })
    }

    /// Performs the step that is due; called once per frame.
    pub(super) fn advance(&mut self, explorer: &mut Explorer, ctx: &Context) {
        self.frames += 1;
        if let Some((_, times, last)) = &mut self.times {
            times.push(last.elapsed().as_secs_f64());
            *last = Instant::now();
        }
        // Only one step per frame, so that its effect is visible before the next step.
        if self.current.is_none() {
            self.current = self.steps.next().map(|(_, step)| step);
            self.frames = 0;
        }
        if let Some(step) = self.current.clone()
            && self.take(explorer, ctx, &step)
        {
            self.current = None;
        }
        ctx.request_repaint();
    }

    /// Performs a step; returns whether it is complete.
    fn take(&mut self, explorer: &mut Explorer, ctx: &Context, step: &Step) -> bool {
        let busy = explorer.is_busy();
        let session = explorer.session_mut();
        match step {
            Step::WaitFinished => {
                return matches!(session.phase(), Phase::Finished(_) | Phase::Failed | Phase::Opened(_));
            }
            Step::WaitEvaluations(count) => return session.store().len() >= *count || !session.is_running(),
            Step::WaitDrawn => {
                let verified =
                    session.document().selected.is_none() || session.known().is_some_and(|known| known.verified);
                // The viewer shows the scene a few frames later.
                return verified && session.is_drawn() && self.frames > 12;
            }
            // A panel asks in the frame after it was shown.
            Step::WaitAnswered => return session.is_answered() && self.frames > 12,
            Step::WaitProved => return session.proof().is_some(),
            Step::WaitFrames(count) => return self.frames >= *count,
            // A picture arrives some frames after its request.
            Step::WaitBusy => return !busy && self.frames > 6,
            Step::Press(press) => press(session),
            Step::Choose(id) => session.select(*id),
            Step::ChooseDesign(text) => session.paste(text),
            Step::Walk(steps) => session.walk(*steps),
            Step::Modify(variable, value) => session.modify(*variable, *value),
            Step::Heatmap(field) => session.view_mut().layers.heatmap = *field,
            Step::Ellipsoids(kind) => session.view_mut().layers.ellipsoids = *kind,
            Step::Pose(pose) => drop(session.move_platform(*pose)),
            Step::Worst(constraint) => session.show_worst(*constraint),
            Step::Show(panel) => explorer.show(*panel),
            Step::Compare(on) => session.view_mut().comparing = *on,
            Step::Dark(dark) => ctx.set_theme(egui::Theme::from_dark_mode(*dark)),
            Step::Look(viewpoint) => session.look_from(*viewpoint),
            Step::Point(at) => explorer.pointer.extend([Event::PointerMoved(*at)]),
            Step::Drag(path) => explorer.pointer.extend(drag(path)),
            Step::Tool(tool) => explorer.scatter_mut().set_tool(*tool),
            Step::Color(coloring) => explorer.scatter_mut().set_coloring(*coloring),
            Step::Size(size) => ctx.send_viewport_cmd(ViewportCommand::InnerSize(size.to_vec2())),
            Step::Filter(quantity, range) => {
                session.edit(|document| document.filter.set_range(*quantity, Some(*range)))
            }
            Step::File(purpose, path) => {
                // Messages about files saved earlier must not appear in a picture.
                session.dismiss_news();
                explorer.act(ctx, *purpose, path.clone());
            }
            Step::Frames(path) => self.times = Some((path.clone(), Vec::new(), Instant::now())),
            Step::Quit => {
                self.write_times(explorer);
                ctx.send_viewport_cmd(ViewportCommand::Close);
            }
        }
        true
    }

    fn write_times(&mut self, explorer: &mut Explorer) {
        if let Some((path, times, _)) = self.times.take() {
            let lines: Vec<String> = times.iter().map(|seconds| format!("{:.3}", 1e3 * seconds)).collect();
            let text = format!("frame_ms\n{}\n", lines.join("\n"));
            if let Err(words) = kinefront_study::write_whole(&path, text.as_bytes()) {
                explorer.session_mut().notify_error(words);
            }
        }
    }
}

/// Returns the events of pressing the button of the mouse at the first place, moving to the others, and releasing it at the last.
fn drag(path: &[Pos2]) -> Vec<Event> {
    let button = |pos: Pos2, pressed: bool| Event::PointerButton {
        pos,
        button: PointerButton::Primary,
        pressed,
        modifiers: Modifiers::NONE,
    };
    let (Some(&first), Some(&last)) = (path.first(), path.last()) else {
        return Vec::new();
    };
    let moves = path[1..].iter().map(|&at| Event::PointerMoved(at));
    [Event::PointerMoved(first), button(first, true)]
        .into_iter()
        .chain(moves)
        .chain([button(last, false)])
        .collect()
}

/// Reads places of the window.
fn places(text: &str) -> Option<Vec<Pos2>> {
    let numbers: Vec<f32> = text
        .split_whitespace()
        .map(|word| word.parse().ok())
        .collect::<Option<_>>()?;
    let pairs = numbers.chunks_exact(2);
    let is_even = pairs.remainder().is_empty() && numbers.len() > 2;
    is_even.then(|| pairs.map(|pair| Pos2::new(pair[0], pair[1])).collect())
}

/// Reads a place of the window.
fn place(text: &str) -> Option<Pos2> {
    let (x, y) = text.split_once(' ')?;
    Some(Pos2::new(x.parse().ok()?, y.trim().parse().ok()?))
}

fn step(line: &str) -> Option<Step> {
    let (word, rest) = line.split_once(' ').unwrap_or((line, ""));
    let rest = rest.trim();
    let path = || (!rest.is_empty()).then(|| PathBuf::from(rest));
    Some(match word {
        "wait" => match rest.split_once(' ').unwrap_or((rest, "")) {
            ("finished", "") => Step::WaitFinished,
            ("drawn", "") => Step::WaitDrawn,
            ("answered", "") => Step::WaitAnswered,
            ("proved", "") => Step::WaitProved,
            ("evaluations", count) => Step::WaitEvaluations(count.parse().ok()?),
            ("frames", count) => Step::WaitFrames(count.parse().ok()?),
            _ => return None,
        },
        "choose" => match rest.strip_prefix('#') {
            Some(id) => Step::Choose(id.parse().ok()?),
            None if rest == "knee" => Step::Press(Session::select_knee),
            None if rest.is_empty() => return None,
            None => Step::ChooseDesign(rest.to_owned()),
        },
        "walk" => Step::Walk(rest.parse().ok()?),
        "pin" => Step::Press(Session::toggle_pin),
        "keep" => Step::Press(Session::keep),
        "star" => Step::Press(Session::toggle_star),
        "what-if" => {
            let (key, value) = rest.split_once('=')?;
            let mut variables = DESIGN_VARIABLES.into_iter().chain(FURTHER_VARIABLES);
            let variable = variables.find(|variable| variable.key() == key)?;
            Step::Modify(variable, value.parse().ok()?)
        }
        "heatmap" if rest == "none" => Step::Heatmap(None),
        "heatmap" => Step::Heatmap(Some(Field::find(rest)?)),
        "ellipsoids" if rest == "none" => Step::Ellipsoids(None),
        "ellipsoids" => Step::Ellipsoids(Some(EllipsoidKind::ALL.into_iter().find(|kind| kind.key() == rest)?)),
        "pose" => Step::Pose(rest.parse().ok()?),
        "worst" => Step::Worst(Constraint::ALL.into_iter().find(|constraint| constraint.id() == rest)?),
        "violation" if rest.is_empty() => Step::Press(Session::show_violation),
        "show" => Step::Show(Panel::ALL.iter().copied().find(|panel| panel.title() == rest)?),
        "compare" => Step::Compare(rest == "on"),
        "theme" => Step::Dark(rest != "light"),
        "look" => Step::Look(
            Viewpoint::ALL
                .into_iter()
                .find(|viewpoint| viewpoint.name().eq_ignore_ascii_case(rest))?,
        ),
        "point" => Step::Point(place(rest)?),
        "click" => Step::Drag(vec![place(rest)?]),
        "drag" => Step::Drag(places(rest)?),
        "tool" => Step::Tool(DragTool::find(rest)?),
        "color" => Step::Color(Coloring::find(rest)?),
        "size" => Step::Size(place(rest)?),
        "pause" => Step::Press(Session::pause),
        "resume" => Step::Press(Session::resume),
        "stop" => Step::Press(Session::stop),
        "filter" => {
            let mut words = rest.split_whitespace();
            let quantity = Column::find_quantity(words.next()?)?;
            let mut number = || words.next()?.parse::<f64>().ok();
            Step::Filter(quantity, [number()?, number()?])
        }
        "beside" => Step::File(Purpose::OpenBeside, path()?),
        "picture" => Step::File(Purpose::SavePicture, path()?),
        "save" => Step::File(Purpose::SaveRecording, path()?),
        "frames" => Step::Frames(path()?),
        "quit" => Step::Quit,
        _ => return None,
    })
}
