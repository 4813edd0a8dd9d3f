//! The front panel: a table of the front, or of the marked designs, with columns by choice, which can be sorted, searched and
//! copied.

mod order;

use std::borrow::Cow;

use egui::{Align, Button, Label, RichText, Sense, Ui, WidgetInfo, WidgetType};
use egui_extras::{TableBuilder, TableRow};
use kinefront_scene::text;
use kinefront_study::{CertifiedWorkspace, Column, Study};

use self::order::{Listing, Order, SortKey, active};
use super::{add_named, button};
use crate::{FrontEntry, Session, theme};
use kinefront_model::evaluation::{PoseScalar, Quantity};
use kinefront_model::mechanism::DESIGN_VARIABLES;

/// Clearance, of which overlaps are emphasized.
const CLEARANCE: Column = Column::Quantity(Quantity::Worst(PoseScalar::Clearance));

/// The panel with the table of the front.
#[derive(Default)]
pub struct FrontPanel {
    listing: Listing,
    /// Columns that the user has chosen; the usual ones if `None`.
    chosen: Option<Vec<Column>>,
    order: Order,
    last_selected: Option<usize>,
}

/// State that determines how a row is drawn.
#[derive(Clone, Copy)]
struct RowState {
    /// Whether its design passes the filter.
    passes: bool,
    /// Whether its design is the selected one.
    selected: bool,
}

/// What the user clicked in the table.
#[derive(Default)]
struct Clicked {
    /// Id of the design to select.
    design: Option<usize>,
    /// Id of the design whose star is toggled.
    star: Option<usize>,
}

/// The columns of quantities that the table has unless the user chooses others.
fn usual_columns(study: &Study) -> Vec<Column> {
    let shown = study.shown_quantities().into_iter().map(Column::Quantity);
    shown
        .filter(|column| *column != CLEARANCE)
        .chain([Column::HomePhi])
        .chain(DESIGN_VARIABLES.map(Column::Dimension))
        .chain([CLEARANCE])
        .collect()
}

/// The columns that sort the table, with their titles.
fn sortable(columns: &[Column]) -> Vec<(SortKey, String)> {
    let first = [
        (SortKey::Star, "★".to_owned()),
        (SortKey::Id, "#".to_owned()),
        (SortKey::Architecture, "architecture".to_owned()),
    ];
    let numbers = columns.iter().map(|column| (SortKey::Number(*column), column.title()));
    first.into_iter().chain(numbers).collect()
}

/// Returns design `id` as an entry of the table.
fn entry(session: &Session, id: usize) -> Option<Cow<'_, FrontEntry>> {
    match session.place_on_front(id) {
        Some(place) => Some(Cow::Borrowed(&session.front()[place])),
        None => Some(Cow::Owned(FrontEntry::of_search(id, session.store().row(id)?))),
    }
}

impl FrontPanel {
    /// Draws the panel.
    pub fn ui(&mut self, ui: &mut Ui, session: &mut Session) {
        if session.document().marked.is_empty() {
            self.listing.marked = false;
        }
        let columns = self.chosen.clone().unwrap_or_else(|| usual_columns(session.study()));
        self.search_bar(ui, session, &columns);
        if session.front().is_empty() && !self.listing.marked {
            ui.weak("The designs of the front are listed here once a run has found them: start a run in the panel Run, or open one.");
            return;
        }
        self.order.update(session, &self.listing);
        let selected = session.document().selected_id();
        let mut clicked = Clicked::default();
        egui::ScrollArea::horizontal()
            .auto_shrink([false, false])
            .show(ui, |ui| self.table(ui, session, &columns, selected, &mut clicked));
        if let Some(id) = clicked.design {
            session.select(id);
        }
        if let Some(id) = clicked.star {
            session.toggle_star_of(id);
        }
    }

    fn search_bar(&mut self, ui: &mut Ui, session: &Session, columns: &[Column]) {
        ui.horizontal_wrapped(|ui| {
            let marked = session.document().marked.len();
            theme::choice(
                ui,
                &mut self.listing.marked,
                false,
                format!("Front ({})", session.front().len()),
            );
            ui.add_enabled_ui(marked > 0, |ui| {
                theme::choice(ui, &mut self.listing.marked, true, format!("Marked ({marked})"))
                    .on_disabled_hover_text("mark designs in the scatter with Box or Lasso");
            });
            let field = egui::TextEdit::singleline(&mut self.listing.search)
                .hint_text("search: 3-PRR, g3, text of a note")
                .desired_width(180.0);
            add_named(ui, field, "Search the table");
            ui.checkbox(&mut self.listing.starred_only, "starred only");
            ui.menu_button("Columns", |ui| self.column_menu(ui, session, columns));
            let hint = "copies the listed designs with these columns, separated by tabs, for a spreadsheet";
            if button(ui, "Copy table", hint) {
                self.order.update(session, &self.listing);
                ui.ctx().copy_text(tab_separated(session, self.order.ids(), columns));
            }
            let count = |holds: fn(&FrontEntry) -> bool| session.front().iter().filter(|entry| holds(entry)).count();
            let noun = if session.front().len() == 1 {
                "design"
            } else {
                "designs"
            };
            let passing = match session.document().filter.is_empty() {
                true => String::new(),
                false => format!(", {} pass the filter", session.passing().len()),
            };
            ui.weak(format!(
                "{} {noun} on the front{passing}, {} verified on the fine grid, {} proved",
                session.front().len(),
                count(|entry| entry.verified),
                count(|entry| entry.certified.is_some_and(|certified| certified.is_proved)),
            ));
        });
    }

    /// Shows a tick for every column that the table may have.
    fn column_menu(&mut self, ui: &mut Ui, session: &Session, columns: &[Column]) {
        let all: Vec<Column> = Column::quantities(session.study().named_quantities()).collect();
        if ui.button("Usual columns").clicked() {
            self.chosen = None;
        }
        egui::ScrollArea::vertical().max_height(320.0).show(ui, |ui| {
            for column in &all {
                let mut shown = columns.contains(column);
                if ui.checkbox(&mut shown, column.title()).changed() {
                    let is_shown = |other: &Column| {
                        if other == column {
                            shown
                        } else {
                            columns.contains(other)
                        }
                    };
                    // The columns that stay keep their places; a further one comes last.
                    let kept = columns.iter().copied().filter(is_shown);
                    let further = Some(*column).filter(|column| shown && !columns.contains(column));
                    self.chosen = Some(kept.chain(further).collect());
                }
            }
        });
    }

    /// Draws the listed designs.
    fn table(
        &mut self,
        ui: &mut Ui,
        session: &Session,
        columns: &[Column],
        selected: Option<usize>,
        clicked: &mut Clicked,
    ) {
        let columns = sortable(columns);
        let mut table = TableBuilder::new(ui)
            .id_salt("front")
            .striped(true)
            .sense(Sense::click())
            .column(egui_extras::Column::exact(22.0))
            .column(egui_extras::Column::initial(52.0))
            .columns(
                egui_extras::Column::initial(96.0).at_least(40.0).clip(true),
                columns.len() - 2,
            )
            .column(egui_extras::Column::initial(150.0).at_least(50.0).clip(true))
            .column(egui_extras::Column::initial(70.0))
            .column(egui_extras::Column::remainder().clip(true))
            .min_scrolled_height(0.0);
        let ids = self.order.ids();
        // A new selection is scrolled into view once.
        if selected != self.last_selected
            && let Some(row) = ids.iter().position(|&id| Some(id) == selected)
        {
            table = table.scroll_to_row(row, Some(Align::Center));
        }
        self.last_selected = selected;
        let prepared = session.document().filter.prepare(session.store());
        let listing = &mut self.listing;
        table
            .header(20.0, |mut head| header(&mut head, &columns, listing))
            .body(|body| {
                body.rows(18.0, ids.len(), |mut row| {
                    let Some(entry) = entry(session, ids[row.index()]) else {
                        return;
                    };
                    let state = RowState {
                        passes: prepared.passes_entry(&entry),
                        selected: Some(entry.id) == selected,
                    };
                    draw_row(&mut row, session, &entry, &columns, state, clicked);
                });
            });
    }
}

/// Draws the titles; a click sorts the table, a second one in the other direction.
fn header(header: &mut TableRow<'_, '_>, columns: &[(SortKey, String)], listing: &mut Listing) {
    for (key, title) in columns {
        header.col(|ui| {
            let arrow = match (*key == listing.key, listing.descending) {
                (false, _) => "",
                (true, false) => " ⏶",
                (true, true) => " ⏷",
            };
            let button = ui.add(Button::new(format!("{title}{arrow}")).frame(false));
            if button.on_hover_text("sorts the table").clicked() {
                listing.descending = *key == listing.key && !listing.descending;
                listing.key = *key;
            }
        });
    }
    for title in ["proof", "active", "note"] {
        header.col(|ui| drop(ui.label(title)));
    }
}

/// Returns designs as lines of values separated by tabs, after a line with the names of the columns.
fn tab_separated(session: &Session, ids: &[usize], columns: &[Column]) -> String {
    let of_entry = [Column::Id, Column::Architecture, Column::WorkingMode];
    let names = of_entry.iter().chain(columns).map(|column| column.name());
    let mut lines = vec![names.collect::<Vec<_>>().join("\t")];
    for entry in ids.iter().filter_map(|&id| entry(session, id)) {
        let row = entry.to_table_row();
        let cells = of_entry
            .iter()
            .chain(columns)
            .map(|column| column.cell(&row).to_string());
        lines.push(cells.collect::<Vec<_>>().join("\t"));
    }
    lines.push(String::new());
    lines.join("\n")
}

fn draw_row(
    row: &mut TableRow<'_, '_>,
    session: &Session,
    entry: &FrontEntry,
    columns: &[(SortKey, String)],
    state: RowState,
    clicked: &mut Clicked,
) {
    let document = session.document();
    row.set_selected(state.selected);
    row.col(|ui| {
        if is_star_clicked(ui, entry.id, document.stars.contains(&entry.id)) {
            clicked.star = Some(entry.id);
        }
    });
    for (key, _) in &columns[1..] {
        row.col(|ui| {
            let text = RichText::new(cell(entry, *key));
            let text = match key {
                // The row's own colour of text is legible on its ground; no other is in both themes.
                _ if state.selected => text,
                SortKey::Number(CLEARANCE) if entry.row.clearance().is_some_and(|clearance| clearance < 0.0) => {
                    text.color(theme::bad(ui))
                }
                _ if !state.passes => text.weak(),
                SortKey::Architecture => text.color(theme::architecture(
                    entry.row.design.architecture(),
                    ui.visuals().dark_mode,
                )),
                _ => text,
            };
            ui.add(Label::new(text).selectable(false));
        });
    }
    row.col(|ui| {
        if let Some(certified) = &entry.certified {
            draw_proof(ui, certified, state);
        }
    });
    row.col(|ui| drop(ui.add(Label::new(active(entry)).selectable(false))));
    row.col(|ui| {
        let note = document.notes.get(&entry.id).cloned().unwrap_or_default();
        ui.add(Label::new(note).selectable(false));
    });
    if row.response().clicked() {
        clicked.design = Some(entry.id);
    }
}

/// Draws the star of a design; returns whether it was clicked.
fn is_star_clicked(ui: &mut Ui, id: usize, is_starred: bool) -> bool {
    let star = if is_starred { "★" } else { "☆" };
    let button = ui.add(Button::new(star).frame(false));
    button.widget_info(|| WidgetInfo::selected(WidgetType::Checkbox, true, is_starred, format!("star #{id}")));
    button.clicked()
}

/// Draws whether the workspace of a design is proved, and between which radii it ends.
fn draw_proof(ui: &mut Ui, certified: &CertifiedWorkspace, state: RowState) {
    let color = if certified.is_proved {
        theme::good(ui)
    } else {
        theme::active(ui)
    };
    let upper = certified.upper.map_or("∞".to_owned(), |upper| format!("{upper:.4}"));
    let words = if certified.is_of_region {
        certified.state().to_owned()
    } else {
        format!("{} [{:.4}, {upper}]", certified.state(), certified.lower)
    };
    let words = RichText::new(words);
    let words = if state.selected { words } else { words.color(color) };
    ui.add(Label::new(words).selectable(false))
        .on_hover_text(certified.to_string());
}

fn cell(entry: &FrontEntry, key: SortKey) -> String {
    match key {
        SortKey::Star => String::new(),
        SortKey::Id => format!("#{}", entry.id),
        SortKey::Architecture => text::architecture(entry.row.design.architecture()),
        SortKey::Number(quantity) => theme::number(entry.row.number(quantity).unwrap_or(f64::NAN)),
    }
}
