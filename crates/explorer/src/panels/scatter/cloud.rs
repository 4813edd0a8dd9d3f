//! A picture of up to a million designs: they are drawn into pixels once, and later only new designs are added.
//!
//! Shapes, in contrast, would be built and sent to the graphics card again in every frame. While the view moves, the
//! picture is stretched, and a new one is drawn off screen for a few milliseconds per frame.

use std::time::{Duration, Instant};

use egui::{Color32, ColorImage, Context, TextureHandle, TextureOptions};

use super::axis::ScatterAxis;
use super::coloring::{ColorScale, Coloring, density};
use crate::data::PreparedFilter;
use crate::{Store, theme};

/// View that a picture shows; a different view requires a new picture.
#[derive(Debug, Clone, PartialEq)]
pub struct View {
    /// Width and height \[pixels\].
    pub size: [usize; 2],
    /// Smallest coordinates shown.
    pub low: [f64; 2],
    /// Largest coordinates shown.
    pub high: [f64; 2],
    /// Colours of the values of the quantity that the colour tells, if it tells one.
    pub scale: Option<ColorScale>,
    /// Everything else that determines the pixels.
    pub style: Style,
}

/// Settings that determine which designs are drawn and how.
#[derive(Debug, Clone, PartialEq)]
pub struct Style {
    /// The axes.
    pub axes: [ScatterAxis; 2],
    /// Number of the store that the ids belong to.
    pub era: u64,
    /// Text of the filter.
    pub filter: String,
    /// What the colour of a design tells.
    pub coloring: Coloring,
    /// Whether the background is dark.
    pub dark: bool,
}

/// Id of a pixel that shows no design.
const NOBODY: u32 = u32::MAX;

/// Number of designs drawn between two checks of the deadline.
const BATCH: usize = 4096;

/// Marks of 5 × 5 pixels, one byte per row: disc, square, triangle, diamond.
const MARKS: [[u8; 5]; 4] = [
    [0b01110, 0b11111, 0b11111, 0b11111, 0b01110],
    [0b11111, 0b11111, 0b11111, 0b11111, 0b11111],
    [0b00100, 0b00100, 0b01110, 0b01110, 0b11111],
    [0b00100, 0b01110, 0b11111, 0b01110, 0b00100],
];
/// Mark of infeasible and dimmed designs, and of every design if there are more than [`CROWD`].
const SMALL: [u8; 5] = [0, 0b01110, 0b01110, 0b01110, 0];
/// Number of designs above which all marks are small.
const CROWD: usize = 100_000;

/// Width and height of the cells in which designs are counted \[pixels\].
const CELL: usize = 4;

struct CloudImage {
    view: View,
    pixels: Vec<Color32>,
    /// Rank of the design that each pixel shows; a design never covers one of a higher rank.
    rank: Vec<u8>,
    /// Id of the design that each pixel shows.
    ids: Vec<u32>,
    /// Number of feasible designs that pass the filter in each cell, row by row; empty unless the colour tells it.
    counts: Vec<u32>,
    /// Number of designs drawn so far.
    drawn: usize,
}

impl CloudImage {
    fn new(view: View) -> Self {
        let count = view.size[0] * view.size[1];
        let cells = match view.style.coloring {
            Coloring::Density => view.size[0].div_ceil(CELL) * view.size[1].div_ceil(CELL),
            _ => 0,
        };
        Self {
            pixels: vec![Color32::TRANSPARENT; count],
            rank: vec![0; count],
            ids: vec![NOBODY; count],
            counts: vec![0; cells],
            drawn: 0,
            view,
        }
    }

    /// Draws designs until `deadline`; returns whether any was drawn.
    fn draw(&mut self, store: &Store, prepared: &PreparedFilter<'_>, deadline: Instant) -> bool {
        let before = self.drawn;
        let [x, y] = self.view.style.axes;
        let (xs, ys) = (store.column(x.quantity), store.column(y.quantity));
        let View { size, low, high, .. } = self.view;
        let scale = [0, 1].map(|k| size[k] as f64 / (high[k] - low[k]));
        let dark = self.view.style.dark;
        let ground = theme::ground(dark);
        let colors: Vec<Color32> = kinefront_model::mechanism::Architecture::ALL
            .iter()
            .map(|&architecture| theme::architecture(architecture, dark))
            .collect();
        let crowded = store.len() > CROWD || !self.counts.is_empty();
        let values = match self.view.style.coloring {
            Coloring::Quantity(column) => self.view.scale.map(|scale| (scale, store.column(column))),
            _ => None,
        };
        while self.drawn < store.len() && Instant::now() < deadline {
            let end = (self.drawn + BATCH).min(store.len());
            for id in self.drawn..end {
                let column = (x.place(xs[id]) - low[0]) * scale[0];
                let row = (high[1] - y.place(ys[id])) * scale[1];
                // Negated, so that NaN counts as outside.
                if !(column >= 0.0 && row >= 0.0 && column < size[0] as f64 && row < size[1] as f64) {
                    continue;
                }
                let feasible = store.is_feasible(id);
                let passes_filter = prepared.passes(id);
                let index = theme::index(store.architecture(id));
                let told = match values {
                    Some((scale, values)) if feasible => scale.color(values[id]),
                    _ => None,
                };
                let color = told.unwrap_or(colors[index]);
                let (rank, color) = match (passes_filter, feasible) {
                    (true, true) => (4, theme::mix(color, ground, 0.85)),
                    (true, false) => (3, theme::infeasible(dark)),
                    (false, true) => (2, theme::mix(color, ground, 0.16)),
                    (false, false) => (1, theme::mix(theme::infeasible(dark), ground, 0.22)),
                };
                let mark = if crowded || rank < 4 {
                    &SMALL
                } else {
                    &MARKS[index % MARKS.len()]
                };
                self.stamp(mark, column as usize, row as usize, rank, color, id as u32);
                if rank == 4 && !self.counts.is_empty() {
                    let cell = row as usize / CELL * size[0].div_ceil(CELL) + column as usize / CELL;
                    self.counts[cell] += 1;
                }
            }
            self.drawn = end;
        }
        self.drawn > before
    }

    fn stamp(&mut self, mark: &[u8; 5], column: usize, row: usize, rank: u8, color: Color32, id: u32) {
        let [width, height] = self.view.size;
        for (dy, bits) in mark.iter().enumerate() {
            let Some(y) = (row + dy).checked_sub(2).filter(|&y| y < height) else {
                continue;
            };
            for dx in 0..5 {
                if bits >> (4 - dx) & 1 == 0 {
                    continue;
                }
                if let Some(x) = (column + dx).checked_sub(2).filter(|&x| x < width) {
                    let at = y * width + x;
                    if rank >= self.rank[at] {
                        self.rank[at] = rank;
                        self.pixels[at] = color;
                        self.ids[at] = id;
                    }
                }
            }
        }
    }
}

impl CloudImage {
    /// Returns the number of designs in the fullest cell.
    fn most(&self) -> u32 {
        self.counts.iter().copied().max().unwrap_or(0)
    }

    /// Returns the picture; where the colour tells the number of designs, the cells are drawn over the marks.
    fn colored(&self) -> ColorImage {
        let [width, height] = self.view.size;
        let mut pixels = self.pixels.clone();
        let (most, dark) = (self.most(), self.view.style.dark);
        let across = width.div_ceil(CELL);
        for (cell, &count) in self.counts.iter().enumerate().filter(|(_, count)| **count > 0) {
            let color = density(count, most, dark);
            let (left, top) = (cell % across * CELL, cell / across * CELL);
            for y in top..(top + CELL).min(height) {
                pixels[y * width + left..y * width + (left + CELL).min(width)].fill(color);
            }
        }
        ColorImage::new(self.view.size, pixels)
    }
}

/// The picture on screen, and the one that will replace it.
#[derive(Default)]
pub struct Cloud {
    shown: Option<CloudImage>,
    coming: Option<CloudImage>,
    texture: Option<TextureHandle>,
}

impl Cloud {
    /// Draws the designs of the store that `view` shows, for at most `budget`; returns whether all of them are drawn.
    pub fn advance(
        &mut self,
        ctx: &Context,
        store: &Store,
        prepared: &PreparedFilter<'_>,
        view: &View,
        budget: Duration,
    ) -> bool {
        let deadline = Instant::now() + budget;
        if let Some(shown) = self.shown.as_mut().filter(|shown| shown.view == *view) {
            self.coming = None;
            let changed = shown.draw(store, prepared, deadline);
            let done = shown.drawn == store.len();
            if changed {
                self.upload(ctx);
            }
            return done;
        }
        let coming = match &mut self.coming {
            Some(coming) if coming.view == *view => coming,
            other => other.insert(CloudImage::new(view.clone())),
        };
        coming.draw(store, prepared, deadline);
        let done = coming.drawn == store.len();
        // After a change of store, filter, axes or theme, an incomplete new picture is better than a complete old one.
        let stale = self.shown.as_ref().is_none_or(|shown| shown.view.style != view.style);
        if done || stale {
            self.shown = self.coming.take();
            self.upload(ctx);
        }
        done
    }

    fn upload(&mut self, ctx: &Context) {
        let Some(shown) = &self.shown else {
            return;
        };
        let image = shown.colored();
        match &mut self.texture {
            Some(texture) => texture.set(image, TextureOptions::NEAREST),
            None => self.texture = Some(ctx.load_texture("designs", image, TextureOptions::NEAREST)),
        }
    }

    /// Returns the largest number of designs in one place; none unless the colour tells it.
    pub fn most(&self) -> Option<u32> {
        let shown = self.shown.as_ref()?;
        (!shown.counts.is_empty()).then(|| shown.most())
    }

    /// Returns the picture with its smallest and largest coordinates.
    pub fn picture(&self) -> Option<(&TextureHandle, [f64; 2], [f64; 2])> {
        let shown = self.shown.as_ref()?;
        Some((self.texture.as_ref()?, shown.view.low, shown.view.high))
    }

    /// Returns the id of the design nearest to `place`, at most `reach` pixels away along each axis.
    pub fn at(&self, place: [f64; 2], reach: isize) -> Option<usize> {
        let CloudImage { view, ids, .. } = self.shown.as_ref()?;
        let View { size, low, high, .. } = view;
        let column = ((place[0] - low[0]) / (high[0] - low[0]) * size[0] as f64) as isize;
        let row = ((high[1] - place[1]) / (high[1] - low[1]) * size[1] as f64) as isize;
        let mut nearest: Option<(isize, u32)> = None;
        for dy in -reach..=reach {
            for dx in -reach..=reach {
                let (x, y) = (column + dx, row + dy);
                if x < 0 || y < 0 || x >= size[0] as isize || y >= size[1] as isize {
                    continue;
                }
                let id = ids[y as usize * size[0] + x as usize];
                let distance = dx * dx + dy * dy;
                if id != NOBODY && nearest.is_none_or(|(least, _)| distance < least) {
                    nearest = Some((distance, id));
                }
            }
        }
        nearest.map(|(_, id)| id as usize)
    }
}
