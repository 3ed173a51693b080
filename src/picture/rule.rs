//! A rule as a drawing: left what its pattern matches, right what its action makes of it (Thaller, Augsdoerfer,
//! Fellner 2016, Figure 4): marks red, links as blue arrows.

use crate::grammar::{Case, Rule, RuleSet, Sample};
use crate::mesh::{HalfEdgeId, Mesh, Node, Value};
use glam::DVec2;
use std::fmt::Write;

/// Pixels per unit of the sample mesh, whose faces have sides of length 1.
const SCALE: f64 = 260.0;
const MARGIN: f64 = 46.0;
/// Between the two meshes, for the arrow.
const GAP: f64 = 130.0;
const RED: &str = "#c8102e";
const BLUE: &str = "#1f5fbf";
const GREY: &str = "#777";
const STYLE: &str = "line{stroke:#222;stroke-width:1.6}circle{fill:#222}text{font:13px sans-serif;fill:#222}";

/// `rule` of `set` as an SVG document: on a mesh made from its pattern. Where none can be made, or the action fails on
/// it, the meshes of `case` are drawn instead, before and after all rules; without a case the document says why.
pub fn rule_svg(set: &RuleSet, rule: &Rule, case: Option<&Case>) -> String {
    let sample = Sample::new(set, rule);
    let result = sample.as_ref().map(|sample| sample.apply(set));
    if !matches!(result, Ok(Ok(_)))
        && let Some(Ok([before, after])) = case.map(Case::before_and_after)
    {
        let [low, high] = bounds(&before, Some(&after));
        return pair(&rule.name, &before, None, &Ok(after), SCALE / (high - low).max_element().max(1e-9));
    }
    match (&sample, result) {
        (Ok(sample), Ok(result)) => {
            let result = result.map_err(|error| error.to_string());
            pair(&rule.name, &sample.mesh, Some(sample), &result, SCALE)
        }
        (Err(reason), _) | (_, Err(reason)) => note(&rule.name, &format!("no drawing: {reason}")),
    }
}

/// Two meshes side by side, or one and why there is no other.
fn pair(
    title: &str,
    before: &Mesh,
    sample: Option<&Sample>,
    after: &Result<Mesh, String>,
    scale: f64,
) -> String {
    let bounds = bounds(before, after.as_ref().ok());
    let size = (bounds[1] - bounds[0]) * scale;
    let right = MARGIN + size.x + GAP;
    let mut page = Page { svg: String::new(), bounds, left: MARGIN, scale };
    page.mesh(before, before);
    if let Some(sample) = sample {
        page.names(sample);
    }
    let middle = 30.0 + MARGIN + size.y / 2.0;
    page.arrow(right - 0.68 * GAP, right - 0.32 * GAP, middle);
    page.left = right;
    match after {
        Ok(after) => page.mesh(after, before),
        Err(error) => {
            let line = error.lines().find_map(|line| line.strip_prefix("error: ")).unwrap_or(error);
            let text = format!("the action needs more: {line}");
            page.text(DVec2::new(right, middle), &text, GREY, "start");
        }
    }
    let width = if after.is_ok() { right + size.x + MARGIN } else { right + 620.0 };
    document(title, width, size.y + 2.0 * MARGIN + 30.0, &page.svg)
}

fn document(title: &str, width: f64, height: f64, body: &str) -> String {
    let title = escape(title);
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width:.0}\" height=\"{height:.0}\" viewBox=\"0 0 {width:.0} {height:.0}\">\n\
         <title>{title}</title>\n<style>{STYLE}</style>\n\
         <defs>{}{}</defs>\n\
         <rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n\
         <text x=\"{MARGIN}\" y=\"26\" style=\"font-weight:bold;font-size:15px\">{title}</text>\n{body}</svg>\n",
        tip("tip", "#222"),
        tip("blue", BLUE)
    )
}

/// An arrow head.
fn tip(id: &str, colour: &str) -> String {
    format!(
        "<marker id=\"{id}\" viewBox=\"0 0 10 10\" refX=\"9\" refY=\"5\" markerWidth=\"10\" markerHeight=\"10\" \
         markerUnits=\"userSpaceOnUse\" orient=\"auto\"><path d=\"M0 0L10 5L0 10z\" fill=\"{colour}\"/></marker>"
    )
}

/// A document of a few words.
fn note(title: &str, text: &str) -> String {
    let body = format!("<text x=\"{MARGIN}\" y=\"56\" style=\"fill:{GREY}\">{}</text>\n", escape(text));
    document(title, 640.0, 80.0, &body)
}

fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

fn bounds(before: &Mesh, after: Option<&Mesh>) -> [DVec2; 2] {
    let mut bounds = [DVec2::INFINITY, DVec2::NEG_INFINITY];
    for mesh in [Some(before), after].into_iter().flatten() {
        for v in mesh.vertices() {
            let p = mesh.position(v).truncate();
            bounds = [bounds[0].min(p), bounds[1].max(p)];
        }
    }
    bounds
}

struct Page {
    svg: String,
    bounds: [DVec2; 2],
    left: f64,
    /// Pixels per unit.
    scale: f64,
}

impl Page {
    fn place(&self, p: DVec2) -> DVec2 {
        DVec2::new(
            self.left + (p.x - self.bounds[0].x) * self.scale,
            30.0 + MARGIN + (self.bounds[1].y - p.y) * self.scale,
        )
    }

    fn line(&mut self, a: DVec2, b: DVec2, style: &str) {
        let _ = writeln!(
            self.svg,
            "<line x1=\"{:.1}\" y1=\"{:.1}\" x2=\"{:.1}\" y2=\"{:.1}\" style=\"{style}\"/>",
            a.x, a.y, b.x, b.y
        );
    }

    fn text(&mut self, at: DVec2, text: &str, colour: &str, anchor: &str) {
        let _ = writeln!(
            self.svg,
            "<text x=\"{:.1}\" y=\"{:.1}\" style=\"fill:{colour};text-anchor:{anchor}\">{}</text>",
            at.x,
            at.y + 4.5,
            escape(text)
        );
    }

    fn arrow(&mut self, x1: f64, x2: f64, y: f64) {
        self.line(DVec2::new(x1, y), DVec2::new(x2, y), "stroke-width:3;marker-end:url(#tip)");
    }

    /// The half-edge on the paper: a little inside of its face.
    fn inside(&self, mesh: &Mesh, h: HalfEdgeId, by: f64) -> [DVec2; 2] {
        let [a, b] = [mesh.source(h), mesh.target(h)].map(|v| self.place(mesh.position(v).truncate()));
        // On the paper y points down: the face on the left of a -> b lies this way.
        let normal = (b - a).normalize_or_zero().perp() * -by;
        [a + normal, b + normal]
    }

    /// Edges, vertices, marks and links of a mesh. What `before` does not have is drawn bolder.
    fn mesh(&mut self, mesh: &Mesh, before: &Mesh) {
        for h in mesh.edges() {
            let [a, b] = self.inside(mesh, h, 0.0);
            let is_new = !std::ptr::eq(mesh, before) && !before.has_half_edge(h);
            self.line(a, b, if is_new { "stroke-width:2.6" } else { "" });
        }
        for h in mesh.half_edges() {
            self.half_edge(mesh, h);
        }
        for v in mesh.vertices() {
            let p = self.place(mesh.position(v).truncate());
            let radius = if before.has_vertex(v) { 3.0 } else { 4.6 };
            let _ = writeln!(self.svg, "<circle cx=\"{:.1}\" cy=\"{:.1}\" r=\"{radius}\"/>", p.x, p.y);
            let words = words(mesh, Node::Vertex(v));
            // The others would run into one another.
            let first = words.split(", ").next().unwrap_or("");
            self.text(p + DVec2::new(6.0, -11.0), first, GREY, "start");
        }
        for f in mesh.faces() {
            let p = self.place(mesh.place(Node::Face(f)).truncate());
            let words = words(mesh, Node::Face(f));
            self.text(p, &words, RED, "middle");
        }
    }

    fn half_edge(&mut self, mesh: &Mesh, h: HalfEdgeId) {
        let node = Node::HalfEdge(h);
        let words = words(mesh, node);
        let links = mesh.links_from(node);
        let carries = mesh.attribute_names(node).iter().any(|&name| mesh.symbol_name(name) != "places");
        // What carries a link is shown by the link.
        if carries && links.is_empty() {
            let [a, b] = self.inside(mesh, h, 4.0);
            let shrink = (b - a) * 0.06;
            self.line(a + shrink, b - shrink, &format!("stroke:{RED};stroke-width:3.4"));
            let [a, b] = self.inside(mesh, h, 32.0);
            self.text(a.midpoint(b), &words, RED, "middle");
        }
        for (label, to) in links {
            let from = self.place(mesh.place(node).truncate());
            let (from, to) = match to {
                Node::HalfEdge(to) => {
                    let [a, b] = self.inside(mesh, h, 9.0);
                    let [c, d] = self.inside(mesh, to, 9.0);
                    (a.midpoint(b), c.midpoint(d))
                }
                other => (from, self.place(mesh.place(other).truncate())),
            };
            let bow = (to - from).perp() * -0.12;
            let middle = from.midpoint(to) + bow;
            let _ = writeln!(
                self.svg,
                "<path d=\"M{:.1} {:.1}Q{:.1} {:.1} {:.1} {:.1}\" style=\"fill:none;stroke:{BLUE};stroke-width:2.2;marker-end:url(#blue)\"/>",
                from.x, from.y, middle.x, middle.y, to.x, to.y
            );
            let label = mesh.symbol_name(label).to_owned();
            self.text(middle + bow.normalize_or_zero() * 9.0, &label, BLUE, "middle");
        }
    }

    /// The names of the pattern's nodes.
    fn names(&mut self, sample: &Sample) {
        for (name, node) in &sample.nodes {
            let at = match *node {
                Node::HalfEdge(h) => {
                    let [a, b] = self.inside(&sample.mesh, h, -14.0);
                    a.midpoint(b)
                }
                node => self.place(sample.mesh.place(node).truncate()) + DVec2::new(-10.0, 14.0),
            };
            self.text(at, name, GREY, "middle");
        }
    }
}

/// Attributes as words: the name, and the value where it is a number or a text.
fn words(mesh: &Mesh, node: Node) -> String {
    let names = mesh.attribute_names(node).into_iter();
    let list: Vec<String> = names
        .filter_map(|name| {
            let text = mesh.symbol_name(name);
            Some(match mesh.attribute(node, name)? {
                Value::Number(x) => format!("{text} {x}"),
                Value::Text(word) => format!("{text} {word}"),
                Value::Vector(_) | Value::Numbers(_) => text.to_owned(),
            })
        })
        .collect();
    list.join(", ")
}
