//! Colours: linear light, its sRGB encoding, and the diverging colour map of deviations.

use std::sync::LazyLock;

/// Red, green, blue as linear light, 1 is white paper.
pub(super) type Light = [f32; 3];

/// Entries of the table that encodes linear light; fine enough that neighbours differ by one byte at most.
const ENCODING_STEPS: usize = 4096;

/// Blue end, middle and red end of the map in CIELAB (D65). The ends have equal lightness and similar chroma, so that
/// deviations of either sign stand out alike.
const BLUE: [f64; 3] = [40.0, 14.0, -52.0];
const MIDDLE: [f64; 3] = [89.0, 0.0, 0.0];
const RED: [f64; 3] = [40.0, 55.0, 33.0];

/// Linear light of an sRGB byte triple.
pub(super) fn from_srgb(bytes: [u8; 3]) -> Light {
    bytes.map(|byte| {
        let s = f32::from(byte) / 255.0;
        if s <= 0.04045 { s / 12.92 } else { ((s + 0.055) / 1.055).powf(2.4) }
    })
}

/// sRGB bytes of linear light; values outside [0, 1] are clamped.
pub(super) fn to_srgb(light: Light) -> [u8; 3] {
    static TABLE: LazyLock<Vec<u8>> = LazyLock::new(|| {
        (0..=ENCODING_STEPS)
            .map(|i| {
                let l = i as f32 / ENCODING_STEPS as f32;
                let s = if l <= 0.003_130_8 { 12.92 * l } else { 1.055 * l.powf(1.0 / 2.4) - 0.055 };
                (s * 255.0).round() as u8
            })
            .collect()
    });
    light.map(|l| {
        let i = (l.clamp(0.0, 1.0) * ENCODING_STEPS as f32).round() as usize;
        TABLE.get(i).copied().unwrap_or(255)
    })
}

/// A table of the diverging map from blue over light grey to red.
///
/// Lightness falls linearly from the middle to either end and chroma rises linearly, which CIELAB makes even to the
/// eye (after K. Moreland, Diverging Color Maps for Scientific Visualization, ISVC 2009, with straight paths).
pub(super) struct DivergingMap {
    table: Vec<Light>,
}

impl DivergingMap {
    const STEPS: usize = 512;

    pub(super) fn new() -> Self {
        let table = (0..=Self::STEPS).map(|i| diverging(2.0 * i as f64 / Self::STEPS as f64 - 1.0)).collect();
        Self { table }
    }

    /// Colour of `t` in [-1, 1]; beyond it the end colours. A value that is not a number is dark grey.
    pub(super) fn colour(&self, t: f32) -> Light {
        if t.is_nan() {
            return [0.1; 3];
        }
        let i = ((t.clamp(-1.0, 1.0) + 1.0) / 2.0 * Self::STEPS as f32).round() as usize;
        self.table.get(i).copied().unwrap_or([0.1; 3])
    }
}

fn diverging(t: f64) -> Light {
    let end = if t < 0.0 { BLUE } else { RED };
    let share = t.abs();
    let [l, a, b] = [0, 1, 2].map(|i| MIDDLE[i] + share * (end[i] - MIDDLE[i]));
    lab_to_light(l, a, b)
}

/// CIELAB (white D65) to linear sRGB primaries, clipped to the gamut.
fn lab_to_light(l: f64, a: f64, b: f64) -> Light {
    let inverse =
        |f: f64| if f > 6.0 / 29.0 { f.powi(3) } else { 3.0 * (6.0f64 / 29.0).powi(2) * (f - 4.0 / 29.0) };
    let fy = (l + 16.0) / 116.0;
    let x = 0.950_47 * inverse(fy + a / 500.0);
    let y = inverse(fy);
    let z = 1.088_83 * inverse(fy - b / 200.0);
    [
        3.240_454_2 * x - 1.537_138_5 * y - 0.498_531_4 * z,
        -0.969_266 * x + 1.876_010_8 * y + 0.041_556 * z,
        0.055_643_4 * x - 0.204_025_9 * y + 1.057_225_2 * z,
    ]
    .map(|v| v.clamp(0.0, 1.0) as f32)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// CIE lightness from relative luminance (ITU-R BT.709 weights), which the map does not use itself.
    fn lightness(bytes: [u8; 3]) -> f64 {
        let [r, g, b] = from_srgb(bytes).map(f64::from);
        let y = 0.2126 * r + 0.7152 * g + 0.0722 * b;
        116.0 * y.cbrt() - 16.0
    }

    #[test]
    fn bytes_survive_linear_light() {
        for byte in 0..=255 {
            assert_eq!(to_srgb(from_srgb([byte; 3])), [byte; 3]);
        }
        assert!((from_srgb([188; 3])[0] - 0.5029).abs() < 1e-4, "published value of sRGB 188");
        assert_eq!(to_srgb([f32::NAN, -1.0, 9.0])[1..], [0, 255]);
    }

    #[test]
    fn map_is_symmetric_and_monotone_in_lightness() {
        let map = DivergingMap::new();
        let at = |t: f32| to_srgb(map.colour(t));
        for i in 0..=100 {
            let t = i as f32 / 100.0;
            assert!((lightness(at(t)) - lightness(at(-t))).abs() < 0.6, "{t}");
        }
        for i in 0..50 {
            let t = i as f32 / 50.0;
            let fall = lightness(at(t)) - lightness(at(t + 0.02));
            assert!((0.3..1.7).contains(&fall), "even steps of lightness: {fall} at {t}");
        }
        let [r, g, b] = at(0.0);
        assert!(r.abs_diff(g) <= 1 && g.abs_diff(b) <= 1, "the middle is grey");
        assert!(at(1.0)[0] > 150 && at(1.0)[2] < 80 && at(-1.0)[2] > 150 && at(-1.0)[0] < 80);
        assert_eq!(at(7.0), at(1.0));
        assert_eq!(at(f32::NEG_INFINITY), at(-1.0));
    }
}
