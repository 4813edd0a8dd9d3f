//! The front panel: a table of the front, which can be sorted and searched, with stars and notes.

use crate::study::{Column, Study};
use crate::text;
use egui::{Align, Label, RichText, Sense, Ui};
use egui_extras::{TableBuilder, TableRow};

use crate::explorer::{FrontEntry, Origin, Session, theme};
use kinefront_model::evaluation::Constraint;
use kinefront_model::mechanism::DESIGN_VARIABLES;

/// Column by which the table is sorted.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Key {
    Star,
    Id,
    Architecture,
    Number(Column),
}

/// The panel with the table of the front.
pub struct FrontPanel {
    key: Key,
    descending: bool,
    search: String,
    starred_only: bool,
    last_selected: Option<usize>,
}

impl Default for FrontPanel {
    fn default() -> Self {
        Self {
            key: Key::Number(Column::Mass),
            descending: false,
            search: String::new(),
            starred_only: false,
            last_selected: None,
        }
    }
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

/// The columns that sort the table, with their titles.
fn sortable(study: &Study) -> Vec<(Key, String)> {
    let number = |column: Column| (Key::Number(column), column.title());
    let always = [
        Column::Mass,
        Column::WorkspaceRadius,
        Column::Value(Constraint::Clearance),
    ];
    let named = study.named_quantities().iter().map(Column::of_quantity);
    let others: Vec<Column> = named.filter(|column| !always.contains(column)).collect();
    [
        (Key::Star, "★".to_owned()),
        (Key::Id, "#".to_owned()),
        (Key::Architecture, "architecture".to_owned()),
    ]
    .into_iter()
    .chain([Column::Mass, Column::WorkspaceRadius].map(number))
    .chain(others.into_iter().map(number))
    .chain([number(Column::HomePhi)])
    .chain(DESIGN_VARIABLES.map(|variable| number(Column::Dimension(variable))))
    .chain([number(Column::Value(Constraint::Clearance))])
    .collect()
}

impl FrontPanel {
    /// Draws the panel.
    pub fn ui(&mut self, ui: &mut Ui, session: &mut Session) {
        self.search_bar(ui, session);
        let order = self.order(session);
        let selected = match session.document().selected.as_ref().map(|selected| &selected.origin) {
            Some(Origin::Evaluated(id)) => Some(*id),
            _ => None,
        };
        let mut clicked = Clicked::default();
        egui::ScrollArea::horizontal()
            .auto_shrink([false, false])
            .show(ui, |ui| self.table(ui, session, &order, selected, &mut clicked));
        if let Some(id) = clicked.design {
            session.select(id);
        }
        if let Some(id) = clicked.star {
            session.toggle_star_of(id);
        }
    }

    fn search_bar(&mut self, ui: &mut Ui, session: &Session) {
        ui.horizontal_wrapped(|ui| {
            let field = ui.add(
                egui::TextEdit::singleline(&mut self.search)
                    .hint_text("search: 3-PRR, g3, text of a note")
                    .desired_width(180.0),
            );
            ui.ctx()
                .accesskit_node_builder(field.id, |node| node.set_label("Search the table"));
            ui.checkbox(&mut self.starred_only, "starred only");
            let count = |holds: fn(&FrontEntry) -> bool| session.front().iter().filter(|entry| holds(entry)).count();
            ui.weak(format!(
                "{} designs on the front, {} verified on the fine grid, {} proved",
                session.front().len(),
                count(|entry| entry.verified),
                count(|entry| entry.certified.is_some_and(|certified| certified.is_proved)),
            ));
        });
    }

    /// Draws the designs in the given order of their places on the front.
    fn table(
        &mut self,
        ui: &mut Ui,
        session: &Session,
        order: &[usize],
        selected: Option<usize>,
        clicked: &mut Clicked,
    ) {
        let columns = sortable(session.study());
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
        // A new selection is scrolled into view once.
        if selected != self.last_selected
            && let Some(row) = order
                .iter()
                .position(|&place| Some(session.front()[place].id) == selected)
        {
            table = table.scroll_to_row(row, Some(Align::Center));
        }
        self.last_selected = selected;
        let prepared = session.document().filter.prepare(session.store());
        table
            .header(20.0, |mut header| self.header(&mut header, &columns))
            .body(|body| {
                body.rows(18.0, order.len(), |mut row| {
                    let entry = &session.front()[order[row.index()]];
                    let state = RowState {
                        passes: prepared.passes_entry(entry),
                        selected: Some(entry.id) == selected,
                    };
                    draw_row(&mut row, session, entry, &columns, state, clicked);
                });
            });
    }

    /// Draws the titles; a click sorts the table, a second one in the other direction.
    fn header(&mut self, header: &mut TableRow<'_, '_>, columns: &[(Key, String)]) {
        for (key, title) in columns {
            header.col(|ui| {
                let arrow = match (*key == self.key, self.descending) {
                    (false, _) => "",
                    (true, false) => " ⏶",
                    (true, true) => " ⏷",
                };
                let button = egui::Button::new(format!("{title}{arrow}")).frame(false);
                if ui.add(button).clicked() {
                    self.descending = *key == self.key && !self.descending;
                    self.key = *key;
                }
            });
        }
        header.col(|ui| drop(ui.label("proof")));
        header.col(|ui| drop(ui.label("active")));
        header.col(|ui| drop(ui.label("note")));
    }

    /// Returns the positions on the front of the listed designs, in the order of the table.
    fn order(&self, session: &Session) -> Vec<usize> {
        let document = session.document();
        let search = self.search.trim().to_lowercase();
        let found = |entry: &FrontEntry| {
            search.is_empty()
                || entry.row.design.to_string().to_lowercase().contains(&search)
                || format!("#{}", entry.id).contains(&search)
                || active(entry).contains(&search)
                || document
                    .notes
                    .get(&entry.id)
                    .is_some_and(|note| note.to_lowercase().contains(&search))
        };
        let mut order: Vec<usize> = (0..session.front().len())
            .filter(|&place| {
                let entry = &session.front()[place];
                found(entry) && (!self.starred_only || document.stars.contains(&entry.id))
            })
            .collect();
        let number = |place: usize| {
            let entry = &session.front()[place];
            match self.key {
                Key::Star => f64::from(u8::from(!document.stars.contains(&entry.id))),
                Key::Id => entry.id as f64,
                Key::Architecture => theme::index(entry.row.design.architecture) as f64,
                Key::Number(quantity) => entry.row.number(quantity).unwrap_or(f64::NAN),
            }
        };
        order.sort_by(|&a, &b| number(a).total_cmp(&number(b)));
        if self.descending {
            order.reverse();
        }
        order
    }
}

fn draw_row(
    row: &mut TableRow<'_, '_>,
    session: &Session,
    entry: &FrontEntry,
    columns: &[(Key, String)],
    state: RowState,
    clicked: &mut Clicked,
) {
    let document = session.document();
    row.set_selected(state.selected);
    row.col(|ui| {
        let star = if document.stars.contains(&entry.id) {
            "★"
        } else {
            "☆"
        };
        if ui.add(egui::Button::new(star).frame(false)).clicked() {
            clicked.star = Some(entry.id);
        }
    });
    for (key, _) in &columns[1..] {
        row.col(|ui| {
            let text = RichText::new(cell(entry, *key));
            let text = match key {
                Key::Number(Column::Value(Constraint::Clearance))
                    if entry.row.clearance().is_some_and(|clearance| clearance < 0.0) =>
                {
                    text.color(theme::bad(ui))
                }
                _ if !state.passes => text.weak(),
                Key::Architecture if !state.selected => text.color(theme::architecture(
                    entry.row.design.architecture,
                    ui.visuals().dark_mode,
                )),
                _ => text,
            };
            ui.add(Label::new(text).selectable(false));
        });
    }
    row.col(|ui| {
        if let Some(certified) = &entry.certified {
            let color = if certified.is_proved {
                theme::good(ui)
            } else {
                theme::active(ui)
            };
            let upper = certified.upper.map_or("∞".to_owned(), |upper| format!("{upper:.4}"));
            let words = format!("{} [{:.4}, {upper}]", certified.state(), certified.lower);
            let words = RichText::new(words).color(color);
            ui.add(Label::new(words).selectable(false))
                .on_hover_text(certified.to_string());
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

fn cell(entry: &FrontEntry, key: Key) -> String {
    match key {
        Key::Star => String::new(),
        Key::Id => format!("#{}", entry.id),
        Key::Architecture => text::architecture(entry.row.design.architecture),
        Key::Number(quantity) => theme::number(entry.row.number(quantity).unwrap_or(f64::NAN)),
    }
}

fn active(entry: &FrontEntry) -> String {
    let ids: Vec<&str> = entry.row.active_constraints().map(Constraint::id).collect();
    ids.join(" ")
}
