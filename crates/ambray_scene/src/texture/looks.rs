//! Many looks into prepared textures at once, as structure of arrays: the arithmetic of [`Sampler::sample`] without its
//! branches, so that neighbouring looks share their instructions.

use glam::{Vec2, Vec4};

use super::{
    Filter, Sampler, Wrap,
    lookup::{Quad, log2_above_one},
    prepared::{Level, PreparedTexture},
    taps::Axis,
};

/// Looks that are worked on at once.
const LANES: usize = 64;

type Lanes<T> = [T; LANES];

/// Looks into textures, each with a `tag` of the caller's.
#[derive(Debug)]
pub(crate) struct Looks<'a> {
    textures: Vec<&'a PreparedTexture>,
    tags: Lanes<u32>,
    uv: [Lanes<f32>; 2],
    /// Footprints, texels of the full image.
    texels: Lanes<f32>,
    /// Number of the smallest level.
    last: Lanes<u32>,
    modes: Lanes<Mode>,
    blend: Blends,
    fine: Quads,
    coarse: Quads,
}

/// Which levels are read, and how they are weighed.
#[derive(Debug)]
struct Blends {
    fine: Lanes<u32>,
    coarse: Lanes<u32>,
    /// Weight of the coarse one; 0 if it need not be read.
    share: Lanes<f32>,
    /// [`Filter::half`] of the filter between texels.
    half: Lanes<f32>,
}

/// Four texels of a level and how they are weighed.
#[derive(Debug)]
struct Quads {
    /// Width and height of the level.
    size: [Lanes<i32>; 2],
    /// Left and right ones, then upper and lower ones.
    taps: [[Lanes<i32>; 2]; 2],
    /// Of the right ones, and of the lower ones.
    shares: [Lanes<f32>; 2],
}

/// A [`Sampler`] as bits.
#[derive(Clone, Copy, Debug)]
pub(super) struct Mode(u32);

impl Mode {
    /// Of u and of v, as the next.
    const MIRROR: [u32; 2] = [1, 2];
    const CLAMP: [u32; 2] = [4, 8];
    /// No filter between texels where the texture is magnified, and where it is minified.
    const NEAREST_MAGNIFIED: u32 = 16;
    const NEAREST_MINIFIED: u32 = 32;
    /// Level 0 alone.
    const FULL_IMAGE: u32 = 64;
    /// No filter between levels.
    const NEAREST_LEVEL: u32 = 128;

    pub(super) fn of(sampler: &Sampler) -> Self {
        let bit = |is: bool, bit: u32| if is { bit } else { 0 };
        let wrap = |axis: usize| match sampler.wrap[axis] {
            Wrap::Repeat => 0,
            Wrap::Mirror => Self::MIRROR[axis],
            Wrap::Clamp => Self::CLAMP[axis],
        };
        Self(
            wrap(0)
                | wrap(1)
                | bit(sampler.mag == Filter::Nearest, Self::NEAREST_MAGNIFIED)
                | bit(sampler.min == Filter::Nearest, Self::NEAREST_MINIFIED)
                | bit(sampler.mip.is_none(), Self::FULL_IMAGE)
                | bit(sampler.mip == Some(Filter::Nearest), Self::NEAREST_LEVEL),
        )
    }

    #[inline(always)]
    const fn axis(self, axis: usize) -> Axis {
        Axis { is_mirror: self.has(Self::MIRROR[axis]), is_clamp: self.has(Self::CLAMP[axis]) }
    }

    #[inline(always)]
    const fn has(self, bit: u32) -> bool {
        self.0 & bit != 0
    }
}

impl<'a> Looks<'a> {
    /// None yet.
    pub(crate) fn new() -> Self {
        let quads = || Quads { size: [[0; LANES]; 2], taps: [[[0; LANES]; 2]; 2], shares: [[0.0; LANES]; 2] };
        Self {
            textures: Vec::with_capacity(LANES),
            tags: [0; LANES],
            uv: [[0.0; LANES]; 2],
            texels: [0.0; LANES],
            last: [0; LANES],
            modes: [Mode(0); LANES],
            blend: Blends { fine: [0; LANES], coarse: [0; LANES], share: [0.0; LANES], half: [0.0; LANES] },
            fine: quads(),
            coarse: quads(),
        }
    }

    /// Whether there is no room for another one.
    #[inline(always)]
    pub(crate) fn is_full(&self) -> bool {
        self.textures.len() == LANES
    }

    /// Adds a look at `uv` of `texture`, for a footprint of `width` texture units. There must be room.
    #[inline(always)]
    pub(crate) fn push(&mut self, texture: &'a PreparedTexture, uv: Vec2, width: f32, tag: u32) {
        let i = self.textures.len();
        self.textures.push(texture);
        self.tags[i] = tag;
        self.uv[0][i] = uv.x;
        self.uv[1][i] = uv.y;
        self.texels[i] = width * texture.image.texels_across;
        self.last[i] = texture.image.last_level();
        self.modes[i] = texture.mode;
    }

    /// Gives each look's tag and value, the bits of [`Sampler::sample`], to `take`; forgets the looks.
    #[inline(always)]
    pub(crate) fn take(&mut self, mut take: impl FnMut(u32, Vec4)) {
        // Steps that are the same for all looks, and in between those that depend on memory: so many are on their way from
        // there at once.
        self.choose_levels();
        self.measure_levels();
        self.reduce();
        self.fine.find(&self.uv, &self.modes, &self.blend.half);
        self.coarse.find(&self.uv, &self.modes, &self.blend.half);
        for (i, texture) in self.textures.iter().enumerate() {
            let mut value = texture.read(self.blend.fine[i] as usize, &self.fine.get(i));
            let share = self.blend.share[i];
            if share != 0.0 {
                value = value.lerp(texture.read(self.blend.coarse[i] as usize, &self.coarse.get(i)), share);
            }
            take(self.tags[i], value);
        }
        self.textures.clear();
    }

    /// Which levels the footprints ask for.
    #[inline(always)]
    fn choose_levels(&mut self) {
        let Self { texels, last, modes, blend, .. } = self;
        for i in 0..LANES {
            let (texels, last, mode) = (texels[i], last[i], modes[i]);
            // Not so where the footprint is no number: that reads the full image.
            let is_minified = texels > 1.0;
            let nearest = if is_minified { Mode::NEAREST_MINIFIED } else { Mode::NEAREST_MAGNIFIED };
            let smallest = last as i32 as f32;
            let logarithm = log2_above_one(texels);
            let is_smallest = texels >= power_of_two(last) || logarithm > smallest;
            let level = if is_smallest { smallest } else { logarithm };
            let level = if is_minified && !mode.has(Mode::FULL_IMAGE) { level } else { 0.0 };
            let rounded = (level + 0.5) as i32 as f32;
            let level = if mode.has(Mode::NEAREST_LEVEL) { rounded } else { level };
            let fine = level as i32;
            blend.fine[i] = fine as u32;
            blend.coarse[i] = (fine as u32 + 1).min(last);
            blend.share[i] = level - fine as f32;
            blend.half[i] = if mode.has(nearest) { 0.0 } else { 0.5 };
        }
    }

    /// Sizes of these levels.
    #[inline(always)]
    fn measure_levels(&mut self) {
        let Self { textures, blend, fine, coarse, .. } = self;
        for (i, texture) in textures.iter().enumerate() {
            for (level, quads) in [(blend.fine[i], &mut *fine), (blend.coarse[i], &mut *coarse)] {
                let Level { size, .. } = texture.image.levels[level as usize];
                quads.size[0][i] = size[0];
                quads.size[1][i] = size[1];
            }
        }
    }

    /// Replaces the coordinates by reduced ones.
    #[inline(always)]
    fn reduce(&mut self) {
        for axis in 0..2 {
            for i in 0..LANES {
                self.uv[axis][i] = self.modes[i].axis(axis).reduced(self.uv[axis][i]);
            }
        }
    }
}

impl Quads {
    /// Finds the texels around the reduced coordinates `uv`.
    #[inline(always)]
    fn find(&mut self, uv: &[Lanes<f32>; 2], modes: &Lanes<Mode>, half: &Lanes<f32>) {
        for (axis, uv) in uv.iter().enumerate() {
            let [first, second] = &mut self.taps[axis];
            for i in 0..LANES {
                let taps = modes[i].axis(axis).taps(uv[i], self.size[axis][i], half[i]);
                (first[i], second[i], self.shares[axis][i]) = (taps.first, taps.second, taps.share);
            }
        }
    }

    /// Those of look `i`.
    #[inline(always)]
    fn get(&self, i: usize) -> Quad {
        let [[left, right], [upper, lower]] =
            self.taps.each_ref().map(|taps| taps.each_ref().map(|of| of[i] as usize));
        let width = self.size[0][i] as usize;
        Quad::new([left, right], [upper * width, lower * width], [self.shares[0][i], self.shares[1][i]])
    }
}

/// 2 to the power of the number of a level.
#[inline(always)]
fn power_of_two(level: u32) -> f32 {
    f32::from_bits((127 + level) << 23)
}
