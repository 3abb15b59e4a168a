//! The pixel inspector: everything that one pixel of a frame did.
//!
//! The pixel is gathered once more, alone, by the same [`gather`] that made the frame; what it left in its buffers
//! is read, shadow rays are overheard by a `Recording`, and the filter is asked for its verdicts. So nothing here can tell
//! another story than the picture.

mod parts;
mod recording;

use glam::Vec4;

use crate::{
    compose::{finished, smaller_batch},
    direct::{DirectLighting, DirectScratch, Received, direct_irradiance},
    filter::{Filter, Guide, REACH},
    frame::{Frame, GBufferPixel},
    gather::{GatherParams, GatherScratch, Gathered, ShadedPoint, gather},
    sampling::{PixelKey, SampleSets, sample_class},
    settings::{NearRadiance, RadianceSource, Settings},
    trace::World,
};

pub use parts::{AmbientRay, Chord, Meeting, ShadowRay, ShadowSource, Tap};

use recording::Recording;

/// Everything that one pixel of a frame did.
#[derive(Clone, Debug, PartialEq)]
pub struct Inspection {
    /// The pixel, to the right and down.
    pub pixel: (u32, u32),
    /// Its sample class.
    pub class: u8,
    /// What is seen; `None` where no surface is. Then there are no rays and no taps.
    pub surface: Option<GBufferPixel>,
    /// The first batch: all N directions of the pixel in the order of its sample set, also those that were not traced.
    pub rays: Vec<AmbientRay>,
    /// The second batch; empty with thin detection off.
    pub chords: Vec<Chord>,
    /// Rays to lights: from the surface, and with [`RadianceSource::Lit`] from what rays and chords met.
    pub shadows: Vec<ShadowRay>,
    /// The window of the filter, row by row.
    pub taps: Vec<Tap>,
    /// Sums of both batches: O1, A2 and the near radiance that belongs to each.
    pub gathered: Gathered,
    /// Openness (x) and near radiance (yzw) before the filter.
    pub raw: Vec4,
    /// Openness (x) and near radiance (yzw) after the filter, of this frame alone: what accumulation makes of it is in the
    /// frame.
    pub filtered: Vec4,
}

impl Inspection {
    /// Rays of all types that were traced for the pixel: [`GBufferPixel::rays`], counted.
    #[must_use]
    pub fn ray_count(&self) -> usize {
        1 + self.rays.iter().filter(|ray| ray.is_traced).count() + self.chords.len() + self.shadows.len()
    }
}

/// A pixel outside the picture was asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("pixel {x}, {y} is outside the picture of {width} x {height} pixels")]
pub struct OutsidePicture {
    /// What was asked for, pixels from the left.
    pub x: u32,
    /// Pixels from the top.
    pub y: u32,
    /// Pixels in a row of the picture.
    pub width: u32,
    /// Its rows.
    pub height: u32,
}

/// What pixel `(x, y)` of `frame` did. `settings` are those of the frame, and `world` is the scene at its moment.
///
/// Where the backend of the frame computes as this function does, on the processor, [`Inspection::raw`] is the pixel of
/// [`Frame::ambient_raw`] bit for bit.
///
/// # Errors
/// If the pixel is outside the picture.
pub fn inspect(
    world: &impl World,
    settings: &Settings,
    frame: &Frame,
    (x, y): (u32, u32),
) -> Result<Inspection, OutsidePicture> {
    let (width, height) = (frame.width, frame.height);
    if x >= width || y >= height {
        return Err(OutsidePicture { x, y, width, height });
    }
    let samples = SampleSets::of(settings);
    let params = GatherParams::new(settings, &frame.view, &samples);
    let inspector = Inspector { world, settings, frame, params };
    let i = inspector.index(x, y);
    let surface = frame.gbuffer[i];
    let mut inspection = Inspection {
        pixel: (x, y),
        class: sample_class(x, y),
        surface: None,
        rays: Vec::new(),
        chords: Vec::new(),
        shadows: Vec::new(),
        taps: Vec::new(),
        gathered: Gathered { openness: 1.0, first: 1.0, second: 1.0, ..Gathered::default() },
        raw: Vec4::X,
        filtered: Vec4::X,
    };
    if surface.is_surface() {
        inspection.surface = Some(surface);
        inspector.direct(&mut inspection);
        inspector.ambient(&mut inspection);
        inspector.filter(&mut inspection);
    }
    Ok(inspection)
}

/// What a pixel is inspected with.
struct Inspector<'a, W> {
    world: &'a W,
    settings: &'a Settings,
    frame: &'a Frame,
    params: GatherParams<'a>,
}

impl<W: World> Inspector<'_, W> {
    fn index(&self, x: u32, y: u32) -> usize {
        y as usize * self.frame.width as usize + x as usize
    }

    fn key(&self, (x, y): (u32, u32)) -> PixelKey {
        PixelKey::new(x, y, self.settings.frame, self.settings.seed)
    }

    fn point(&self, (x, y): (u32, u32)) -> ShadedPoint {
        self.frame.gbuffer[self.index(x, y)].shaded_point(self.key((x, y)))
    }

    /// Shadow rays of the direct light at the surface.
    fn direct(&self, inspection: &mut Inspection) {
        let (x, y) = inspection.pixel;
        let receiver = self.frame.gbuffer[self.index(x, y)].receiver(self.key((x, y)));
        let lighting =
            DirectLighting { lights: self.params.lights, offset: self.params.offset, shadows: true };
        let recording = Recording::new(self.world);
        let mut received = [Received::default()];
        direct_irradiance(&recording, lighting, &[receiver], &mut DirectScratch::default(), &mut received);
        inspection.shadows = recording.shadows(self.params.lights.len(), |_| Some(ShadowSource::Surface));
    }

    /// Both batches.
    fn ambient(&self, inspection: &mut Inspection) {
        let (params, point) = (&self.params, self.point(inspection.pixel));
        let recording = Recording::new(self.world);
        let mut scratch = GatherScratch::default();
        let mut gathered = [Gathered::default()];
        gather(&recording, params, &[point], &mut scratch, &mut gathered);
        [inspection.gathered] = gathered;
        inspection.rays = scratch.rays(params, &point);
        inspection.chords = scratch.chords(self.world, params, &point);
        if params.source == RadianceSource::Lit && params.near_radiance != NearRadiance::Off {
            let sources = scratch.sources(params);
            let source = |seed| sources.get(&seed).copied();
            inspection.shadows.extend(recording.shadows(params.lights.len(), source));
        }
        let (first, second) = self.before_filter(&inspection.gathered);
        inspection.raw = self.finished(first, second);
    }

    fn before_filter(&self, gathered: &Gathered) -> (Vec4, Option<Vec4>) {
        gathered.before_filter(self.settings.takes_minimum_after_filter())
    }

    /// Openness and near radiance as they are shown, of both batches or of the smaller one.
    fn finished(&self, first: Vec4, second: Option<Vec4>) -> Vec4 {
        let smaller = second.map_or(first, |second| smaller_batch(first, second));
        finished(self.params.source, self.params.ambient, smaller)
    }

    /// The window, and what comes of it: the filter itself runs on a picture that ends where the window does.
    fn filter(&self, inspection: &mut Inspection) {
        let (x, y) = inspection.pixel;
        let near = |at: u32, end: u32| at.saturating_sub(REACH)..(at + REACH + 1).min(end);
        let (columns, rows) = (near(x, self.frame.width), near(y, self.frame.height));
        let centre = ((x - columns.start) as usize, (y - rows.start) as usize);
        let width = columns.len();
        let pixels: Vec<_> = rows.flat_map(|row| columns.clone().map(move |column| (column, row))).collect();
        let camera = &self.frame.view.camera;
        let seen = |&(x, y): &(u32, u32)| &self.frame.gbuffer[self.index(x, y)];
        let guides: Vec<Guide> = pixels.iter().map(|pixel| seen(pixel).guide(camera)).collect();

        let filter = Filter::from(self.settings);
        let tap = |(offset, weight, verdict): ([i32; 2], f32, _)| {
            let moved = |at: u32, by: i32, end: u32| at.checked_add_signed(by).filter(|&at| at < end);
            let pixel = moved(x, offset[0], self.frame.width).zip(moved(y, offset[1], self.frame.height));
            let value = pixel.filter(|pixel| seen(pixel).is_surface());
            let value = value.map(|(x, y)| self.frame.ambient_raw[self.index(x, y)]);
            Tap { offset, pixel, weight, verdict, value }
        };
        inspection.taps = filter.taps(&guides, width, centre).into_iter().map(tap).collect();

        // The neighbours are gathered too: the near radiance in the frame may be past what the filter takes.
        let surfaces: Vec<usize> = (0..pixels.len()).filter(|&i| guides[i].is_surface()).collect();
        let points: Vec<_> = surfaces.iter().map(|&i| self.point(pixels[i])).collect();
        let mut gathered = vec![Gathered::default(); points.len()];
        gather(self.world, &self.params, &points, &mut GatherScratch::default(), &mut gathered);
        let (mut first, mut second) = (vec![Vec4::X; pixels.len()], vec![Vec4::X; pixels.len()]);
        for (&i, gathered) in surfaces.iter().zip(&gathered) {
            let (value, other) = self.before_filter(gathered);
            (first[i], second[i]) = (value, other.unwrap_or(value));
        }
        let (mut first_row, mut second_row) = (vec![Vec4::ZERO; width], vec![Vec4::ZERO; width]);
        let outputs = [&mut first_row[..], &mut second_row[..]];
        filter.filter_row(&guides, width, centre.1, [&first, &second], outputs);
        inspection.filtered = self.finished(first_row[centre.0], Some(second_row[centre.0]));
    }
}
