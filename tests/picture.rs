//! Figures from outside: files that others can read, the same bytes each time, hostile input, real chairs.

use glam::DVec3;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Instant;
use welt::picture::{Camera, Content, EdgeKind, Figure, Finish, Image, MAX_PIXELS, Panel, Shape};

/// A mesh in flat arrays.
#[derive(Default)]
struct Flat {
    positions: Vec<DVec3>,
    sizes: Vec<u32>,
    vertices: Vec<u32>,
}

impl Flat {
    fn shape(&self) -> Shape<'_> {
        Shape { positions: &self.positions, face_sizes: &self.sizes, face_vertices: &self.vertices }
    }

    fn push(&mut self, face: &[usize]) {
        self.sizes.push(face.len() as u32);
        self.vertices.extend(face.iter().map(|&v| v as u32));
    }

    fn faces(&self) -> Vec<Vec<usize>> {
        let mut rest = self.vertices.iter().map(|&v| v as usize);
        self.sizes.iter().map(|&size| rest.by_ref().take(size as usize).collect()).collect()
    }

    /// Vertices and faces of an OBJ file whose indices are positive.
    fn read(path: &Path) -> Self {
        let mut mesh = Self::default();
        for line in fs::read_to_string(path).unwrap().lines() {
            let mut words = line.split_whitespace();
            match words.next() {
                Some("v") => {
                    let p: Vec<f64> = words.map(|word| word.parse().unwrap()).collect();
                    mesh.positions.push(DVec3::new(p[0], p[1], p[2]));
                }
                Some("f") => {
                    let index = |word: &str| word.split('/').next().unwrap().parse::<usize>().unwrap() - 1;
                    mesh.push(&words.map(index).collect::<Vec<_>>());
                }
                _ => {}
            }
        }
        mesh
    }

    /// One step of Catmull and Clark, to have something smooth to look at.
    fn subdivided(&self) -> Self {
        let faces = self.faces();
        let count = self.positions.len();
        let centre =
            |face: &Vec<usize>| face.iter().map(|&v| self.positions[v]).sum::<DVec3>() / face.len() as f64;
        let mut result = Self::default();
        let mut edges: BTreeMap<(usize, usize), (usize, DVec3, usize)> = BTreeMap::new();
        let mut rings = vec![(DVec3::ZERO, 0.0); count];
        for face in &faces {
            for (i, &a) in face.iter().enumerate() {
                let b = face[(i + 1) % face.len()];
                let fresh = edges.len();
                let edge = edges.entry((a.min(b), a.max(b))).or_insert((fresh, DVec3::ZERO, 0));
                edge.1 += centre(face);
                edge.2 += 1;
                rings[a].0 += centre(face);
                rings[a].1 += 1.0;
            }
        }
        let mut middles = vec![DVec3::ZERO; count];
        let mut borders = vec![(DVec3::ZERO, 0); count];
        let mut edge_points = vec![DVec3::ZERO; edges.len()];
        for (&(a, b), &(id, sum, sides)) in &edges {
            let middle = (self.positions[a] + self.positions[b]) / 2.0;
            edge_points[id] = if sides == 2 { (middle * 2.0 + sum) / 4.0 } else { middle };
            for (v, other) in [(a, b), (b, a)] {
                middles[v] += middle;
                if sides != 2 {
                    borders[v].0 += self.positions[other];
                    borders[v].1 += 1;
                }
            }
        }
        for v in 0..count {
            let (p, (sum, n)) = (self.positions[v], rings[v]);
            result.positions.push(match borders[v] {
                (_, 0) if n > 0.0 => (sum / n + middles[v] * 2.0 / n + p * (n - 3.0)) / n,
                (ends, 2) => p * 0.75 + ends / 8.0,
                _ => p,
            });
        }
        result.positions.extend(edge_points);
        for face in &faces {
            let hub = result.positions.len();
            result.positions.push(centre(face));
            for (i, &v) in face.iter().enumerate() {
                let edge = |a: usize, b: usize| count + edges[&(a.min(b), a.max(b))].0;
                let (next, last) = (face[(i + 1) % face.len()], face[(i + face.len() - 1) % face.len()]);
                result.push(&[v, edge(v, next), hub, edge(last, v)]);
            }
        }
        result
    }
}

fn cube() -> Flat {
    let positions =
        (0..8).map(|i| DVec3::new((i & 1) as f64, (i >> 1 & 1) as f64, (i >> 2) as f64)).collect();
    let mut mesh = Flat { positions, ..Flat::default() };
    for face in [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]] {
        mesh.push(&face);
    }
    mesh
}

fn png_of(image: &Image) -> Vec<u8> {
    let mut bytes = Vec::new();
    image.write_png(&mut bytes).unwrap();
    bytes
}

/// A figure of all kinds of panels of one cage and one surface.
fn figure<'a>(
    cage: &'a Flat,
    surface: &'a Flat,
    values: &'a [f64],
    edges: &'a [(u32, u32, EdgeKind)],
) -> Figure<'a> {
    let shape = surface.shape();
    Figure {
        title: "A figure",
        panels: vec![
            Panel {
                content: Content::Cage { shape: cage.shape(), edges, vertices: &[0, 3], label: "displaced" },
                caption: "control mesh",
            },
            Panel {
                content: Content::Surface { shape, normals: &[], finish: Finish::Studio },
                caption: "limit surface",
            },
            Panel {
                content: Content::Scalar { shape, normals: &[], values, range: None, label: "deviation" },
                caption: "difference",
            },
        ],
        camera: Camera::framing(&cage.positions, DVec3::new(1.0, 0.8, 2.0), DVec3::Y),
        width: 900,
        height: 400,
    }
}

#[test]
fn a_figure_is_a_png_of_its_size_and_the_same_each_time() {
    let cage = cube();
    let surface = cage.subdivided().subdivided();
    let values: Vec<f64> = surface.positions.iter().map(|p| p.x - 0.5).collect();
    let edges = [(0, 1, EdgeKind::Marked), (4, 6, EdgeKind::Feature)];
    let figure = figure(&cage, &surface, &values, &edges);
    let image = figure.render();
    let bytes = png_of(&image);
    assert_eq!(bytes, png_of(&figure.render()));

    let mut reader = png::Decoder::new(std::io::Cursor::new(&bytes)).read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut pixels).unwrap();
    assert_eq!((info.width, info.height, info.color_type), (900, 400, png::ColorType::Rgb));
    for (x, y) in [(0, 0), (450, 200), (760, 190), (899, 399)] {
        assert_eq!(pixels[(y * 900 + x) * 3..][..3], image.pixel(x, y).unwrap(), "{x} {y}");
    }
    assert_eq!(image.pixel(900, 0), None);
    assert_eq!(image.pixel(0, 400), None);
}

#[test]
fn colours_show_the_sign_of_the_values() {
    let surface = cube();
    let render = |value: f64| {
        let values = [value; 8];
        let content = Content::Scalar {
            shape: surface.shape(),
            normals: &[],
            values: &values,
            range: Some(1.0),
            label: "",
        };
        let camera = Camera::framing(&surface.positions, DVec3::Z, DVec3::Y);
        let panels = vec![Panel { content, caption: "" }];
        let image = Figure { title: "", panels, camera, width: 300, height: 300 }.render();
        image.pixel(150, 110).unwrap()
    };
    let ([r, _, b], [low_r, _, low_b], middle) = (render(1.0), render(-1.0), render(0.0));
    assert!(r > b.saturating_add(80) && low_b > low_r.saturating_add(80));
    assert!(middle.iter().max().unwrap() - middle.iter().min().unwrap() <= 4);
    let unknown = render(f64::NAN);
    assert!(unknown.iter().all(|&part| part < 110), "no value is dark: {unknown:?}");
}

/// Draws a front wall (vertices 0 to 3) and a smaller one behind it (4 to 7); counts the pixels and the columns that the
/// marked edge colours.
fn marked(edge: (u32, u32)) -> (usize, usize) {
    let mut walls = Flat::default();
    for (z, half) in [(0.0, 1.0), (-1.0, 0.5)] {
        for (x, y) in [(-half, -half), (half, -half), (half, half), (-half, half)] {
            walls.positions.push(DVec3::new(x, y, z));
        }
    }
    walls.push(&[0, 1, 2, 3]);
    walls.push(&[4, 5, 6, 7]);
    let edges = [(edge.0, edge.1, EdgeKind::Marked)];
    let content = Content::Cage { shape: walls.shape(), edges: &edges, vertices: &[], label: "" };
    let camera = Camera::framing(&walls.positions, DVec3::Z, DVec3::Y);
    let panels = vec![Panel { content, caption: "" }];
    let image = Figure { title: "", panels, camera, width: 300, height: 300 }.render();
    let red = |x, y| image.pixel(x, y).is_some_and(|[r, g, _]| r > 150 && g < 100);
    // The lower rows hold the legend.
    let columns: Vec<usize> = (0..300).map(|x| (0..240).filter(|&y| red(x, y)).count()).collect();
    (columns.iter().sum(), columns.iter().filter(|&&count| count > 0).count())
}

#[test]
fn hidden_edges_are_hidden_and_others_have_an_even_width() {
    assert_eq!(marked((4, 5)), (0, 0));
    let (pixels, columns) = marked((2, 3));
    assert!(columns > 200, "the whole edge shows: {columns}");
    let width = pixels as f64 / columns as f64;
    assert!((2.0..=3.5).contains(&width), "{width}");
    // From the hidden wall to the front: it ends in a corner that shows, but lies behind all of the way.
    let (_, columns) = marked((4, 0));
    assert!(columns < 12, "{columns}");
}

#[test]
fn a_surface_looks_the_same_from_its_back() {
    let ball = cube().subdivided().subdivided();
    let mut reversed = Flat { positions: ball.positions.clone(), ..Flat::default() };
    for face in ball.faces() {
        reversed.push(&[face[0], face[3], face[2], face[1]]);
    }
    let outward: Vec<DVec3> = ball.positions.iter().map(|p| p - DVec3::splat(0.5)).collect();
    let render = |shape: Shape<'_>, normals: &[DVec3]| {
        let content = Content::Surface { shape, normals, finish: Finish::Studio };
        let camera = Camera::framing(&ball.positions, DVec3::new(1.0, 2.0, 3.0), DVec3::Y);
        Figure { title: "", panels: vec![Panel { content, caption: "" }], camera, width: 200, height: 200 }
            .render()
    };
    let expected = render(ball.shape(), &outward);
    for other in [
        render(reversed.shape(), &outward),
        render(reversed.shape(), &outward.iter().map(|n| -n).collect::<Vec<_>>()),
    ] {
        for (x, y) in (0..200).flat_map(|y| (0..200).map(move |x| (x, y))) {
            let (p, q) = (expected.pixel(x, y).unwrap(), other.pixel(x, y).unwrap());
            assert!(p.iter().zip(q).all(|(p, q)| p.abs_diff(q) <= 2), "{x} {y}: {p:?} {q:?}");
        }
    }
    let top_left = expected.pixel(70, 60).unwrap();
    let bottom_right = expected.pixel(130, 140).unwrap();
    assert!(top_left[0] > bottom_right[0] + 40, "the light comes from above and left");
}

#[test]
fn hostile_input_gives_a_picture() {
    let bad = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e308, -1e308, 1e-310, 0.0, 5.0];
    let mut mesh = Flat::default();
    for a in bad {
        for b in bad {
            mesh.positions.push(DVec3::new(a, b, 1.0));
            mesh.positions.push(DVec3::new(1.0, b, a));
        }
    }
    for i in 0..mesh.positions.len() {
        mesh.push(&[i, (i * 7 + 1) % 128, (i * 31 + 2) % 128, (i * 13) % 128, i][..3 + i % 3]);
    }
    mesh.push(&[0, 1, 9999]);
    mesh.sizes.extend([0, 1, 2, u32::MAX]);
    let edges = [(0, u32::MAX, EdgeKind::Marked), (3, 3, EdgeKind::Unresolved), (0, 9, EdgeKind::Feature)];
    let text = "\u{1F600} \u{0} tab\t ".repeat(10_000);
    for value in bad {
        let values = vec![value; mesh.positions.len() / 2];
        let mut figure = figure(&mesh, &mesh, &values, &edges);
        figure.title = &text;
        for panel in &mut figure.panels {
            panel.caption = &text;
            if let Content::Scalar { range, label, .. } = &mut panel.content {
                *range = Some(value);
                *label = &text;
            }
        }
        for direction in [DVec3::splat(value), DVec3::new(0.0, value, 1.0)] {
            figure.camera = Camera::framing(&mesh.positions, direction, DVec3::splat(value)).widened(value);
            let image = figure.render();
            assert_eq!((image.width(), image.height()), (900, 400));
        }
    }
}

#[test]
fn sizes_are_clamped_and_the_smallest_figures_are_drawn() {
    let cage = cube();
    for (width, height) in [(0, 0), (1, 1), (3, 2000), (2000, 3), (40, 30), (usize::MAX, usize::MAX)] {
        let mut figure = figure(&cage, &cage, &[1.0; 8], &[]);
        (figure.width, figure.height) = (width, height);
        let image = figure.render();
        assert!(image.width() * image.height() <= MAX_PIXELS);
        assert!(!png_of(&image).is_empty());
    }
    let empty = Flat::default();
    let blank = Figure { panels: Vec::new(), ..figure(&empty, &empty, &[], &[]) }.render();
    assert_eq!(blank.pixel(450, 300), Some([255; 3]));
    figure(&empty, &empty, &[], &[]).render();
    let crowd = figure(&cage, &cage, &[], &[]);
    let panels = crowd.panels.iter().copied().cycle().take(10_000).collect();
    Figure { panels, ..crowd }.render();
}

/// Columns and rows of the first and last pixel that is not white.
fn inked(image: &Image) -> [usize; 4] {
    let ink = |x, y| image.pixel(x, y).is_some_and(|pixel| pixel != [255; 3]);
    let columns: Vec<usize> =
        (0..image.width()).filter(|&x| (0..image.height()).any(|y| ink(x, y))).collect();
    let rows: Vec<usize> = (0..image.height()).filter(|&y| (0..image.width()).any(|x| ink(x, y))).collect();
    [columns[0], columns[columns.len() - 1], rows[0], rows[rows.len() - 1]]
}

/// Directions from which the chairs show well; the figures are left in the folder for test output.
#[test]
fn chairs_fill_their_pictures() {
    let data = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../shared/data/upholstery");
    if !data.exists() {
        println!("skipped: ../shared is absent");
        return;
    }
    let views = [
        ("bs0_chair_cage", DVec3::new(0.9, 0.8, 1.4)),
        ("kl_mid-century-chair_cage", DVec3::new(0.7, 0.9, 1.6)),
        ("sc_armchair2_cage", DVec3::new(0.9, 0.6, 1.6)),
        ("bsby_leaf_chair_cage", DVec3::new(-0.9, 0.6, 1.5)),
    ];
    for (name, viewer) in views {
        let cage = Flat::read(&data.join(name).with_extension("obj"));
        let surface = cage.subdivided().subdivided().subdivided();
        let values: Vec<f64> =
            surface.positions.iter().map(|p| (p.y * 9.0 / cage.positions[0].length()).sin()).collect();
        let edges: Vec<(u32, u32, EdgeKind)> = cage
            .faces()
            .iter()
            .step_by(9)
            .zip([EdgeKind::Feature, EdgeKind::Marked, EdgeKind::Unresolved].into_iter().cycle())
            .map(|(face, kind)| (face[0] as u32, face[1] as u32, kind))
            .collect();
        let mut figure = figure(&cage, &surface, &values, &edges);
        figure.camera = Camera::framing(&surface.positions, viewer, DVec3::Y);
        figure.title = name;
        figure.panels[1].caption = "asked width 0.020, reached 0.0199; asked depth 0.010, reached 0.0100";
        (figure.width, figure.height) = (1500, 600);
        let start = Instant::now();
        let image = figure.render();
        println!("{name}: {} faces in {:?}", surface.sizes.len(), start.elapsed());
        let path = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name).with_extension("png");
        fs::write(path, png_of(&image)).unwrap();

        let content =
            Content::Surface { shape: surface.shape(), normals: &[], finish: Finish::ReflectionLines };
        let panels = vec![Panel { content, caption: "" }];
        let image = Figure { title: "", panels, camera: figure.camera, width: 600, height: 600 }.render();
        let [left, right, top, bottom] = inked(&image);
        let path = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name).with_extension("zebra.png");
        fs::write(path, png_of(&image)).unwrap();
        assert!(left > 10 && top > 10 && right < 590 && bottom < 590, "inside the margins");
        assert!((right - left).max(bottom - top) > 500, "as large as it can be");
        assert!((left + right).abs_diff(600) < 12 && (top + bottom).abs_diff(600) < 12, "in the middle");
    }
}
