//! Handles input from outside the panels: dropped files, pictures taken of the window, and results of file jobs.

use crate::AnyError;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use egui::{Context, Event};

use super::super::files::Purpose;
use super::Explorer;

/// The file that a requested picture of the window is saved to; it accompanies the request.
pub(super) struct PendingScreenshot(pub(super) PathBuf);

impl Explorer {
    /// Opens dropped files, saves pictures that were taken of the window, and reports the results of file jobs.
    pub(super) fn deliveries(&mut self, ctx: &Context) {
        let dropped: Vec<PathBuf> = ctx.input_mut(|input| {
            input.raw.hovered_files.clear();
            std::mem::take(&mut input.raw.dropped_files)
                .iter()
                .map(|file| file.path().to_owned())
                .collect()
        });
        for path in dropped {
            self.act(ctx, Purpose::Open, path);
        }
        let pictures: Vec<(PathBuf, Arc<egui::ColorImage>)> = ctx.input(|input| {
            let taken = input.raw.events.iter().filter_map(|event| match event {
                Event::Screenshot { user_data, image, .. } => {
                    let PendingScreenshot(path) = user_data.data.as_ref()?.downcast_ref()?;
                    Some((path.clone(), Arc::clone(image)))
                }
                _ => None,
            });
            taken.collect()
        });
        for (path, image) in pictures {
            self.begin(ctx, Box::new(move || save_picture(&path, &image)));
        }
        while let Ok(ended) = self.ended.1.try_recv() {
            self.jobs -= 1;
            match ended {
                Ok(words) => self.session.notify(words),
                Err(words) => self.session.notify_error(words),
            }
        }
    }
}

fn save_picture(path: &Path, picture: &egui::ColorImage) -> Result<String, AnyError> {
    let failed = |error: &dyn std::fmt::Display| format!("cannot write {}: {error}", path.display());
    let mut bytes = std::io::Cursor::new(Vec::new());
    let [width, height] = picture.size.map(|side| side as u32);
    let rgb: Vec<u8> = picture
        .pixels
        .iter()
        .flat_map(|pixel| [pixel.r(), pixel.g(), pixel.b()])
        .collect();
    image::RgbImage::from_raw(width, height, rgb)
        .ok_or_else(|| failed(&"the picture is incomplete"))?
        .write_to(&mut bytes, image::ImageFormat::Png)
        .map_err(|error| failed(&error))?;
    kinefront_study::write_whole(path, bytes.get_ref())?;
    Ok(format!("saved {}", path.display()))
}
