//! Light: how a surface looks from the direction of its normal, in the axes of the picture.

use super::colour::Light;

/// Towards the key light: above, left, in front.
const KEY: [f32; 3] = [-0.58, 0.60, 0.55];
/// Towards the fill light: right, low, in front.
const FILL: [f32; 3] = [0.80, -0.10, 0.59];
/// Halfway between the key light and the viewer.
const HIGHLIGHT: [f32; 3] = [-0.330, 0.341, 0.880];

/// How a smooth surface is shown.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug)]
pub enum Finish {
    /// Matt under a key and a fill light, with a weak highlight.
    #[default]
    Studio,
    /// Reflection lines (zebra): stripes that bend where the curvature changes and break where the normal jumps.
    ReflectionLines,
}

/// Stripes, black and white together, over all directions of reflection.
const STRIPES: f32 = 20.0;

pub(super) fn dot(a: [f32; 3], b: [f32; 3]) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// `v` with unit length; the direction to the viewer where it has none.
pub(super) fn unit(v: [f32; 3]) -> [f32; 3] {
    let squared = dot(v, v);
    if squared > f32::MIN_POSITIVE && squared.is_finite() {
        let inverse = 1.0 / squared.sqrt();
        v.map(|part| part * inverse)
    } else {
        [0.0, 0.0, 1.0]
    }
}

/// Light of a matt surface of colour `albedo` with unit normal `n`.
pub(super) fn studio(n: [f32; 3], albedo: Light) -> Light {
    let sky = 0.5 + 0.5 * n[1];
    let diffuse = 0.07 + 0.10 * sky + 0.82 * dot(n, KEY).max(0.0) + 0.18 * dot(n, FILL).max(0.0);
    let glance = dot(n, HIGHLIGHT).max(0.0);
    let glance = glance * glance;
    let glance = glance * glance;
    let glance = glance * glance;
    let glance = glance * glance;
    let shine = 0.10 * glance * glance;
    albedo.map(|part| part * diffuse + shine)
}

/// Light of a coloured surface whose colour must stay readable: lightness falls a little away from the viewer and the key.
pub(super) fn tinted(n: [f32; 3], colour: Light) -> Light {
    let level = 0.44 + 0.34 * dot(n, KEY).max(0.0) + 0.28 * n[2].max(0.0);
    colour.map(|part| part * level)
}

/// Stripes by the height of the mirrored line of sight.
pub(super) fn reflection_lines(n: [f32; 3]) -> Light {
    let height = 2.0 * n[2] * n[1];
    let phase = (height * STRIPES / 4.0).rem_euclid(1.0);
    // A triangle wave, steepened: the rim of a stripe is a narrow ramp instead of a jump.
    let wave = ((0.25 - (phase - 0.5).abs()) * 24.0 + 0.5).clamp(0.0, 1.0);
    // Towards the outline stripes become finer than samples and fade into their mean.
    let clear = (n[2] * 8.0).clamp(0.0, 1.0);
    let level = (0.46 + 0.84 * (wave - 0.5) * clear) * (0.6 + 0.4 * n[2].max(0.0));
    [level; 3]
}
