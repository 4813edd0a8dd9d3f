//! Designs at the corners of what a design may be: a file of another program has no number that is not finite.

use kinefront_export::{ExportError, ExportSubject, Format, export};
use kinefront_model::evaluation::GridChoice;
use kinefront_model::mechanism::{Architecture, DESIGN_VARIABLES, Design, WorkingMode};
use kinefront_study::{PreparedStudy, Study};

/// Base radii from the smallest to the largest that are accepted, with the other lengths in proportion.
const SCALES: [f64; 9] = [1e-150, 1e-40, 1e-20, 1e-3, 1.0, 1e3, 1e20, 1e40, 1e154];

/// Values of the five dimensions for `R` = 1 m: ordinary ones, and extreme ratios.
const SHAPES: [[f64; 5]; 4] = [
    [1.0, 0.35, 0.8, 0.02, 0.03],
    [1.0, 1e-3, 1.0, 1e-9, 1e-9],
    [1.0, 0.5, 900.0, 0.5, 0.5],
    [1.0, 900.0, 1.0, 1e-3, 0.0],
];

#[test]
fn no_format_has_a_number_that_is_not_finite() {
    let study = PreparedStudy::new(Study::default()).expect("the paper's study");
    let (mut written, mut refused) = (0, 0);
    for &architecture in Architecture::ALL {
        for scale in SCALES {
            for shape in SHAPES {
                let Ok(design) = Design::new(architecture, WorkingMode::ALL_PLUS, shape.map(|value| value * scale))
                else {
                    continue;
                };
                let evaluation = study.model().evaluate(&design, GridChoice::Reference);
                let subject = ExportSubject {
                    study: &study,
                    evaluation: &evaluation,
                    pose: None,
                };
                for &format in Format::ALL {
                    match export(&subject, format) {
                        Ok(bytes) => {
                            written += 1;
                            if format.is_text() {
                                let text = String::from_utf8(bytes).expect("UTF-8");
                                let mut words = text.split(|c: char| !c.is_alphanumeric());
                                assert!(
                                    !words.any(|word| word == "NaN" || word == "inf"),
                                    "{design}: {format:?}"
                                );
                            }
                        }
                        Err(ExportError::NotFinite(_)) => refused += 1,
                        Err(ExportError::Unreachable { .. } | ExportError::NoBar(_) | ExportError::NoMotion(_)) => {}
                        Err(error) => panic!("{design}: {format:?}: {error}"),
                    }
                }
            }
        }
    }
    assert!(written > 500 && refused > 20, "{written} written, {refused} refused");
    assert_eq!(DESIGN_VARIABLES.len(), SHAPES[0].len());
}

#[test]
fn a_design_gives_the_same_file_at_any_time() {
    let study = PreparedStudy::new(Study::default()).expect("the paper's study");
    let design = Design::parse(
        "3-PRR R=3.066 r=1.283 Lb=1.896 rj=0.036 rp=0.056",
        WorkingMode::ALL_PLUS,
    );
    let evaluation = study
        .model()
        .evaluate(&design.expect("a design of the paper"), GridChoice::Fine);
    let subject = ExportSubject {
        study: &study,
        evaluation: &evaluation,
        pose: None,
    };
    let write = |&format: &Format| match export(&subject, format) {
        Ok(bytes) => Some(bytes),
        Err(ExportError::NoMotion(_)) => None,
        Err(error) => panic!("{format:?}: {error}"),
    };
    let first: Vec<_> = Format::ALL.iter().map(write).collect();
    assert!(first.iter().flatten().count() > 5);
    // Longer than the resolution of the times that formats state.
    std::thread::sleep(std::time::Duration::from_millis(50));
    for (format, first) in Format::ALL.iter().zip(first) {
        assert!(
            write(format) == first,
            "{format:?} depends on the time at which it is written"
        );
    }
}
