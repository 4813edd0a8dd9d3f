//! `kinefront study new --question`: a dialogue on the terminal that writes a study.

use std::fmt::Write as _;
use std::io::{self, BufRead, Write};

use kinefront_model::evaluation::{Better, Quantity};
use kinefront_model::mechanism::Architecture;
use kinefront_study::{CATALOGUES, MATERIALS, Study, StudyError};

/// Asks questions on a terminal; an empty answer takes the value in brackets.
struct Dialogue<'a, R, W> {
    answers: &'a mut R,
    out: &'a mut W,
}

impl<R: BufRead, W: Write> Dialogue<'_, R, W> {
    /// Asks until `read` accepts the answer; its error says what would be right.
    fn ask<T>(&mut self, question: &str, initial: &str, read: impl Fn(&str) -> Result<T, String>) -> io::Result<T> {
        loop {
            write!(self.out, "{question} [{initial}]: ")?;
            self.out.flush()?;
            let mut line = String::new();
            if self.answers.read_line(&mut line)? == 0 {
                return Err(io::Error::new(
                    io::ErrorKind::UnexpectedEof,
                    "the input ended before all questions were answered",
                ));
            }
            let answer = line.trim();
            match read(if answer.is_empty() { initial } else { answer }) {
                Ok(value) => return Ok(value),
                Err(message) => writeln!(self.out, "  {message}")?,
            }
        }
    }

    fn choose(&mut self, question: &str, choices: &[&str], initial: &str) -> io::Result<String> {
        let question = format!("{question} ({})", choices.join(", "));
        self.ask(&question, initial, |answer| {
            let found = choices.iter().find(|choice| **choice == answer);
            found.map_or_else(
                || Err(format!("`{answer}` is not one of {}", choices.join(", "))),
                |choice| Ok((*choice).to_owned()),
            )
        })
    }

    fn number(&mut self, question: &str, initial: &str) -> io::Result<f64> {
        self.ask(question, initial, above_zero)
    }

    /// Asks for a number above 0, or `none`.
    fn optional(&mut self, question: &str, initial: &str) -> io::Result<Option<f64>> {
        let question = format!("{question}, or none");
        self.ask(&question, initial, |answer| match answer {
            "none" => Ok(None),
            number => above_zero(number).map(Some),
        })
    }
}

fn above_zero(answer: &str) -> Result<f64, String> {
    match answer.parse::<f64>() {
        Ok(number) if number.is_finite() && number > 0.0 => Ok(number),
        _ => Err(format!("`{answer}` is not a number above 0")),
    }
}

/// Asks for a study and returns its text, which is that of a valid study.
///
/// # Errors
/// The error of the terminal; [`io::ErrorKind::InvalidData`] if the answers contradict each other.
pub fn ask(answers: &mut impl BufRead, out: &mut impl Write) -> io::Result<String> {
    let mut dialogue = Dialogue { answers, out };
    writeln!(
        dialogue.out,
        "Answer a few questions; an empty answer accepts the value in brackets.\n"
    )?;
    let mut text = String::from(
        "# Written by `kinefront study new --question`. Every key that is omitted has the value of the study \"paper\".\n\n",
    );
    let name = dialogue.ask("Name of the study", "my-study", |answer| Ok(answer.to_owned()))?;
    let _ = writeln!(text, "name = {}", quoted(&name));
    architectures(&mut dialogue, &mut text)?;
    let region = dialogue.choose("Region of positions", &["largest", "disc", "rectangle"], "largest")?;
    objectives(&mut dialogue, &mut text, &region)?;
    limits(&mut dialogue, &mut text)?;
    write_region(&mut dialogue, &mut text, &region)?;
    sections(&mut dialogue, &mut text)?;
    machine(&mut dialogue, &mut text)?;
    let evaluations = dialogue.number("Number of designs to evaluate", "3000")?;
    let _ = writeln!(text, "\n[optimizer]\nevaluations = {}", evaluations.round().max(1.0));
    Study::parse(&text, &name).map_err(|error| {
        let message = match &error {
            StudyError::Values { faults, .. } => {
                let faults = faults.iter().map(|fault| format!("`{}` {}", fault.key, fault.message));
                faults.collect::<Vec<_>>().join("; ")
            }
            other => other.to_string(),
        };
        io::Error::new(io::ErrorKind::InvalidData, message)
    })?;
    Ok(text)
}

fn quoted(text: &str) -> String {
    format!("\"{}\"", text.replace('\\', "\\\\").replace('"', "\\\""))
}

/// Asks for the architectures: those of the paper by default, because a search of all takes several times as long.
fn architectures(dialogue: &mut Dialogue<impl BufRead, impl Write>, text: &mut String) -> io::Result<()> {
    let all: Vec<&str> = Architecture::ALL
        .iter()
        .map(|architecture| architecture.name())
        .collect();
    writeln!(dialogue.out, "Architectures: {}", all.join(" "))?;
    let paper: Vec<&str> = Study::default()
        .architectures
        .iter()
        .map(|architecture| architecture.name())
        .collect();
    let names = dialogue.ask("Architectures to search, or all", &paper.join(" "), |answer| {
        if answer == "all" {
            return Ok(Architecture::ALL.to_vec());
        }
        let names: Result<Vec<Architecture>, _> = answer.split_whitespace().map(str::parse).collect();
        names.map_err(|error: kinefront_model::mechanism::TextError| error.to_string())
    })?;
    let names: Vec<String> = names.iter().map(|architecture| quoted(architecture.name())).collect();
    let _ = writeln!(text, "architectures = [{}]", names.join(", "));
    Ok(())
}

fn objectives(dialogue: &mut Dialogue<impl BufRead, impl Write>, text: &mut String, region: &str) -> io::Result<()> {
    writeln!(dialogue.out, "Quantities available as objectives and for limits:")?;
    for entry in Quantity::all().map(Quantity::entry) {
        writeln!(dialogue.out, "  {:<20} {}", entry.key, entry.meaning)?;
    }
    let initial = if region == "largest" {
        "mass_kg workspace_radius_m"
    } else {
        "mass_kg"
    };
    let chosen = dialogue.ask("Objectives, one to three", initial, |answer| {
        let keys: Vec<&str> = answer.split_whitespace().collect();
        if !(1..=3).contains(&keys.len()) {
            return Err(format!("{} objectives are named; name one to three", keys.len()));
        }
        keys.into_iter()
            .map(|key| Quantity::find(key).ok_or_else(|| format!("`{key}` is not one of the quantities above")))
            .collect::<Result<Vec<Quantity>, String>>()
    })?;
    let objectives: Vec<String> = chosen
        .into_iter()
        .map(|quantity| {
            let entry = quantity.entry();
            let goal = match entry.better {
                Better::Lower => "minimize",
                Better::Higher => "maximize",
            };
            format!("{{ {goal} = \"{}\" }}", entry.key)
        })
        .collect();
    let _ = writeln!(text, "objectives = [{}]", objectives.join(", "));
    Ok(())
}

fn limits(dialogue: &mut Dialogue<impl BufRead, impl Write>, text: &mut String) -> io::Result<()> {
    let limits = dialogue.ask("Limits, as in `footprint_m<=1.2 dexterity>=0.2`", "none", |answer| {
        if answer == "none" {
            return Ok(Vec::new());
        }
        let limit = |word: &str| {
            let (key, sign, value) = word
                .split_once("<=")
                .map(|(key, value)| (key, "at_most", value))
                .or_else(|| word.split_once(">=").map(|(key, value)| (key, "at_least", value)))
                .ok_or_else(|| format!("`{word}` has neither <= nor >="))?;
            let quantity = Quantity::find(key).ok_or_else(|| format!("`{key}` is not one of the quantities above"))?;
            let value: f64 = value.parse().map_err(|_| format!("`{value}` is not a number"))?;
            Ok(format!("{} = {{ {sign} = {value} }}", quantity.entry().key))
        };
        answer
            .split_whitespace()
            .map(limit)
            .collect::<Result<Vec<String>, String>>()
    })?;
    if !limits.is_empty() {
        let _ = writeln!(text, "\n[constraints]\n{}", limits.join("\n"));
    }
    Ok(())
}

fn write_region(dialogue: &mut Dialogue<impl BufRead, impl Write>, text: &mut String, region: &str) -> io::Result<()> {
    let turn = dialogue.number("Rotation range in degrees", "20")?;
    let _ = writeln!(text, "\n[workspace]\nrotation_range_deg = {turn}");
    match region {
        "disc" => {
            let radius = dialogue.number("Radius of the disc in m", "0.4")?;
            let _ = writeln!(text, "\n[workspace.region]\nkind = \"disc\"\nradius_m = {radius}");
        }
        "rectangle" => {
            let width = dialogue.number("Width along Ox in m", "0.6")?;
            let height = dialogue.number("Height along Oy in m", "0.4")?;
            let _ = writeln!(
                text,
                "\n[workspace.region]\nkind = \"rectangle\"\nwidth_m = {width}\nheight_m = {height}"
            );
        }
        _ => {}
    }
    Ok(())
}

fn sections(dialogue: &mut Dialogue<impl BufRead, impl Write>, text: &mut String) -> io::Result<()> {
    let mut lines = String::new();
    for bars in ["legs", "platform"] {
        let question = format!("Bars of the {bars}");
        let kind = dialogue.choose(&question, &["round", "tube", "square_tube", "catalogue"], "round")?;
        match kind.as_str() {
            "round" => {}
            "catalogue" => {
                let names: Vec<&str> = CATALOGUES.iter().map(|builtin| builtin.name).collect();
                let question = format!("Catalogue: a CSV file, or {}", names.join(", "));
                let name = dialogue.ask(&question, names[0], |answer| Ok(answer.to_owned()))?;
                let _ = writeln!(lines, "{bars} = {{ kind = \"tube\", catalogue = {} }}", quoted(&name));
            }
            kind => {
                let ratio = dialogue.number("Wall thickness as a fraction of the outer radius, in (0, 1]", "0.2")?;
                let _ = writeln!(lines, "{bars} = {{ kind = \"{kind}\", wall_ratio = {ratio} }}");
            }
        }
    }
    if !lines.is_empty() {
        let _ = write!(text, "\n[sections]\n{lines}");
    }
    Ok(())
}

/// Asks for what a machine needs besides: members that do not collide, its material, and joints with a mass.
fn machine(dialogue: &mut Dialogue<impl BufRead, impl Write>, text: &mut String) -> io::Result<()> {
    let clearance = dialogue.optional("Smallest clearance between members that are not joined, in m", "0.005")?;
    if let Some(clearance) = clearance {
        let _ = writeln!(text, "\n[requirements]\nclearance_min_m = {clearance}");
        // Legs that would collide in common layers are in layers of their own.
        let _ = writeln!(text, "\n[bodies]\nstacking = \"chosen\"");
    }
    let names: Vec<&str> = MATERIALS.iter().map(|builtin| builtin.name).collect();
    let material = dialogue.choose("Material", &names, names[0])?;
    let _ = writeln!(text, "\n[material]\nname = {}", quoted(&material));
    let mut joints = String::new();
    for (question, key) in [
        ("Mass of a revolute joint in kg", "revolute_kg"),
        ("Mass of the carriage of a prismatic joint in kg", "carriage_kg"),
        ("Mass of a motor in kg", "motor_kg"),
    ] {
        if let Some(mass) = dialogue.optional(question, "none")? {
            let _ = writeln!(joints, "{key} = {mass}");
        }
    }
    if !joints.is_empty() {
        let _ = write!(text, "\n[joints]\n{joints}");
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use kinefront_model::clearance::Stacking;

    use super::*;

    fn answer(lines: &str) -> io::Result<(String, String)> {
        let mut out = Vec::new();
        let text = ask(&mut lines.as_bytes(), &mut out)?;
        Ok((text, String::from_utf8(out).expect("text")))
    }

    #[test]
    fn empty_answers_ask_the_paper_s_question() {
        let (text, _) = answer(&"\n".repeat(20)).expect("a study");
        let study = Study::parse(&text, "answers").expect("a study");
        assert_eq!(study.objectives(), Study::default().objectives());
        // But for members that do not collide.
        assert_eq!(study.requirements.clearance_min_m, Some(0.005));
        assert_eq!(study.bodies.stacking, Stacking::Chosen);
        assert!(study.constraints.is_empty() && study.architectures == Study::default().architectures);
    }

    #[test]
    fn all_architectures_are_searched_if_asked_for() {
        let (text, said) = answer(&format!("\nall\n{}", "\n".repeat(20))).expect("a study");
        let study = Study::parse(&text, "answers").expect("a study");
        assert_eq!(study.architectures, Architecture::ALL);
        assert!(said.contains("3-_PPR"), "{said}");
    }

    #[test]
    fn answers_become_a_study_and_wrong_ones_are_asked_again() {
        let lines = "cell\n3-PRR 3-XXX\n3-PRR\nrectangle\nweight\nmass_kg footprint_m\nfootprint_m<1\nfootprint_m<=1.5 \
                     dexterity>=0.2\n30\n0.5\n0.3\ntube\n0.25\ncatalogue\n\nnone\nS355\n0.4\n-1\nnone\n2.5\n500\n";
        let (text, said) = answer(lines).expect("a study");
        let study = Study::parse(&text, "answers").expect("a study");
        assert_eq!(
            (study.name.as_str(), study.objectives.len(), study.constraints.len()),
            ("cell", 2, 2)
        );
        assert_eq!(study.workspace.region.width_m, Some(0.5));
        assert_eq!(study.sections.legs.wall_ratio, Some(0.25));
        assert_eq!(
            (study.requirements.clearance_min_m, study.material.yield_strength_pa),
            (None, Some(355e6))
        );
        assert_eq!(
            (
                study.joints.revolute_kg,
                study.joints.carriage_kg,
                study.joints.motor_kg
            ),
            (0.4, 0.0, 2.5)
        );
        assert!(study.sections.platform.catalogue.is_some() && study.optimizer.evaluations == 500);
        for complaint in [
            "`-1` is not a number above 0",
            "unknown architecture `3-XXX`",
            "`weight` is not one",
            "`footprint_m<1` has neither",
        ] {
            assert!(said.contains(complaint), "{complaint}: {said}");
        }
    }

    #[test]
    fn answers_that_end_early_are_an_error() {
        let error = answer("cell\n").expect_err("no more answers");
        assert_eq!(error.kind(), io::ErrorKind::UnexpectedEof);
    }
}
