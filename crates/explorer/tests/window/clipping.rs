//! No text of a panel is cut off at its side, and no two texts overlap, at the sizes that panels have in windows of 1600×1000, 1280×800
//! and 1000×700 points.

use egui::Rect;
use egui::accesskit::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::NodeT as _;
use kinefront_explorer::Panel;

use super::panels::drawing;

/// Sizes of a panel in the three windows, without the frame.
fn sizes(panel: Panel) -> [[f32; 2]; 3] {
    match panel {
        Panel::Run | Panel::Study | Panel::Examples | Panel::Mechanisms => {
            [[470.0, 370.0], [376.0, 290.0], [290.0, 250.0]]
        }
        Panel::Scatter | Panel::Space => [[470.0, 550.0], [376.0, 430.0], [290.0, 370.0]],
        Panel::Front | Panel::Parallel | Panel::Prices | Panel::Motion | Panel::Compare | Panel::Beside => {
            [[724.0, 310.0], [576.0, 240.0], [448.0, 200.0]]
        }
        _ => [[362.0, 420.0], [290.0, 320.0], [224.0, 260.0]],
    }
}

/// Margin of the frame around a panel \[points\].
const MARGIN: f32 = 8.0;

/// A text that is drawn.
struct Text {
    words: String,
    rect: Rect,
}

fn texts(harness: &Harness<'_>) -> Vec<Text> {
    let nodes = harness.root().children_recursive();
    let texts = nodes.filter_map(|node| {
        let shown = node.accesskit_node();
        let is_text = matches!(
            shown.role(),
            Role::Label
                | Role::Button
                | Role::CheckBox
                | Role::RadioButton
                | Role::ComboBox
                | Role::SpinButton
                | Role::TextInput
        );
        let words = shown.label().or_else(|| shown.value()).filter(|_| is_text)?;
        // A table places the cells that are out of view as well.
        let rect = node.rect();
        let is_drawn = !words.trim().is_empty() && rect.is_positive();
        is_drawn.then_some(Text { words, rect })
    });
    texts.collect()
}

/// Returns what is wrong with the texts of a panel of a size.
fn faults(panel: Panel, texts: &[Text], [width, height]: [f32; 2]) -> Vec<String> {
    let name = |words: &str| format!("{} at {width}: {words:?}", panel.title());
    // What lies below is reached by scrolling, and tables scroll to the side as well.
    let seen: Vec<&Text> = texts.iter().filter(|text| text.rect.top() < height).collect();
    let scrolls = matches!(panel, Panel::Front | Panel::Compare | Panel::Beside);
    let mut faults = Vec::new();
    for text in seen.iter().filter(|_| !scrolls) {
        let right = text.rect.right();
        if right > MARGIN + width + 1.0 {
            faults.push(format!("{} ends at {right:.0}", name(&text.words)));
        }
    }
    // The rectangle of a text that continues on the next line holds what is beside it.
    let on_one_line: Vec<&&Text> = seen.iter().filter(|text| text.rect.height() < 26.0).collect();
    for (place, a) in on_one_line.iter().enumerate() {
        for b in &on_one_line[..place] {
            let common = a.rect.intersect(b.rect);
            let nests = a.rect.contains_rect(b.rect) || b.rect.contains_rect(a.rect);
            if common.width() > 2.0 && common.height() > 2.0 && !nests {
                faults.push(format!("{} overlaps {:?}", name(&a.words), b.words));
            }
        }
    }
    faults
}

#[test]
fn no_text_is_cut_off_and_none_overlaps() {
    let (mut found, mut count) = (Vec::new(), 0);
    for &panel in Panel::ALL.iter().filter(|panel| **panel != Panel::Scene) {
        let mut harness = Harness::builder()
            .with_step_dt(1.0 / 60.0)
            .build_ui(drawing(panel, egui::Theme::Dark));
        for size in sizes(panel) {
            harness.set_size(egui::Vec2::from(size) + egui::Vec2::splat(2.0 * MARGIN));
            harness.run_steps(12);
            let texts = texts(&harness);
            count += texts.len();
            found.extend(faults(panel, &texts, size));
        }
    }
    assert!(count > 1000, "{count} texts");
    assert!(found.is_empty(), "{}", found.join("\n"));
}
