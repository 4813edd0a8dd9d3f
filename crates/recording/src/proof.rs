//! Draws the proof of a workspace: its boxes, coloured by the constraint that decided them, and the infeasible pose that ends it.

use glam::{DVec2, DVec3};
use rerun::components::FillMode;
use rerun::{Boxes3D, Color, Mesh3D, Radius};

use super::colors::{self, rgb};
use super::draw::{Canvas, about_z, point};
use super::writer::RecordingError;
use kinefront_model::certify::BoxOutcome;
use kinefront_model::evaluation::PoseScalar;
use kinefront_scene::palette;
use kinefront_scene::{ColorMap, ConfigurationSpace, WorkspaceProof};

/// Number of divisions at which the colour of a box is the brightest.
const DEEPEST: f64 = 24.0;

impl Canvas<'_> {
    /// Draws the boxes in the configuration space below `root`, and the infeasible pose.
    pub(super) fn proof_in_space(
        &self,
        root: &str,
        proof: &WorkspaceProof,
        space: &ConfigurationSpace,
    ) -> Result<(), RecordingError> {
        let cells: Vec<_> = proof.cells().collect();
        let halves = cells.iter().map(|cell| {
            let height = cell.half_phi * space.height;
            [cell.half[0] as f32, cell.half[1] as f32, height as f32]
        });
        let centres = cells.iter().map(|cell| point(space.place(cell.position, cell.phi)));
        let boxes = Boxes3D::from_centers_and_half_sizes(centres, halves)
            .with_rotation_axis_angles(cells.iter().map(|cell| about_z(cell.theta)))
            .with_colors(cells.iter().map(|cell| color(cell.outcome, cell.scalar)))
            .with_radii(std::iter::repeat_n(Radius::new_ui_points(0.5), cells.len()))
            .with_fill_mode(FillMode::MajorWireframe);
        self.row(&format!("{root}/boxes"), &boxes)?;
        if let Some(violation) = proof.certificate.violation {
            let at = space.place(violation.pose.position, violation.pose.phi);
            self.mark(&format!("{root}/violation"), at, &words(proof), colors::LIMIT)?;
        }
        Ok(())
    }

    /// Draws the boxes that contain the orientation `phi` below `root`, at the height `z`: filled by the number of divisions that led
    /// to them, outlined by the constraint that decided them; and the infeasible pose.
    pub(super) fn proof_at(&self, root: &str, proof: &WorkspaceProof, phi: f64, z: f64) -> Result<(), RecordingError> {
        let outlines: Vec<_> = proof.outlines(phi).collect();
        let lift = |p: &DVec2| point(p.extend(z));
        let (mut vertices, mut triangles, mut shades) = (Vec::<[f32; 3]>::new(), Vec::new(), Vec::new());
        for (part, outline) in &outlines {
            let first = vertices.len() as u32;
            // The inner arc and the outer one, which runs back, have the same number of corners.
            let corners = (outline.len() as u32 - 1) / 2;
            vertices.extend(outline.iter().take(2 * corners as usize).map(lift));
            let shade = rgb(ColorMap::at((f64::from(part.depth) / DEEPEST).min(1.0)));
            shades.extend(std::iter::repeat_n(shade, 2 * corners as usize));
            for corner in 0..corners - 1 {
                let (inner, outer) = (first + corner, first + 2 * corners - 1 - corner);
                triangles.extend([[inner, inner + 1, outer], [inner + 1, outer - 1, outer]]);
            }
        }
        let mesh = Mesh3D::new(vertices)
            .with_triangle_indices(triangles)
            .with_vertex_colors(shades);
        self.row(&format!("{root}/depth"), &mesh)?;
        let lines = outlines.iter().map(|(part, outline)| {
            let strip: Vec<[f32; 3]> = outline.iter().map(lift).collect();
            (strip, color(part.outcome, part.scalar), 0.7)
        });
        self.lines(&format!("{root}/boxes"), lines)?;
        if let Some(violation) = proof.certificate.violation {
            let at: DVec3 = violation.pose.position.extend(z);
            self.mark(&format!("{root}/violation"), at, &words(proof), colors::LIMIT)?;
        }
        Ok(())
    }
}

fn words(proof: &WorkspaceProof) -> String {
    proof.certificate.violation.map_or(String::new(), |violation| {
        let degrees = (10.0 * violation.pose.phi.to_degrees()).round() / 10.0;
        format!("{} is violated here at φ = {degrees}°", violation.scalar.limit_id())
    })
}

/// The colour of a box: that of the limit which was proved on it last, or white where nothing is decided.
fn color(outcome: BoxOutcome, scalar: PoseScalar) -> Color {
    match outcome {
        BoxOutcome::Proved => rgb(palette::limited(scalar)),
        BoxOutcome::Beyond => rgb(colors::LIMIT),
        BoxOutcome::Undecided => rgb(colors::WORKSPACE),
    }
}
