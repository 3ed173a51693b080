//! `welt rules check`: warnings, and what the static check knows of scripts; drawings of rules.

use crate::common;

use std::path::Path;
use std::process::Command;
use welt::grammar::{Case, RuleSet};
use welt::picture::rule_svg;

fn rules(text: &str) -> RuleSet {
    RuleSet::parse("t", text, &|_| None).unwrap_or_else(|error| panic!("{error}"))
}

#[track_caller]
fn warned(text: &str, expected: &[&str]) {
    let found: Vec<String> = rules(text)
        .warnings()
        .iter()
        .map(|d| format!("{}:{} {} [{}]", d.line, d.column, d.message, d.word))
        .collect();
    assert_eq!(found, expected, "{text}");
}

#[track_caller]
fn refused(action: &str, expected: &str) {
    let text = format!("rule A {{ e source> v }} action {{ {action} }}");
    let error = RuleSet::parse("t", &text, &|_| None).expect_err(&text);
    let found: Vec<String> =
        error.diagnostics.iter().map(|d| format!("{} [{}]", d.message, d.word)).collect();
    assert_eq!(found, [expected], "{action}");
}

/// Accepted by the static check; whether it works is found when it runs.
#[track_caller]
fn accepted(action: &str) {
    rules(&format!("rule A {{ e source> v }} action {{ {action} }}"));
}

#[test]
fn kinds_are_known_through_loops_branches_exit_catch_and_dictionaries() {
    // Behind loops, exit, throw and catch.
    refused("{ exit } loop 1 e makeEF pop", "`makeEF` needs a half-edge, not a number [makeEF]");
    refused("1 { 1 { exit } if } loop edgemate pop", "`edgemate` needs a half-edge, not a number [edgemate]");
    refused("{ e throw } { pop 1 } catch edgemate", "`edgemate` needs a half-edge, not a number [edgemate]");
    refused("exit", "`exit` outside of a loop [exit]");
    refused("1 1 3 { pop 1 } for v vertexpos 1 add pop", "`add` cannot take a vector and a number [add]");
    // Registers after both branches.
    refused(
        "usereg 1 { 1 !x } { 2 !x } ifelse :x edgemate pop",
        "`edgemate` needs a half-edge, not a number [edgemate]",
    );
    accepted("usereg 1 { 1 !x } { e !x } ifelse :x edgemate pop");
    // A later turn of a loop may bring another kind.
    accepted("usereg 1 !x 3 { :x pop e !x } repeat :x edgemate pop");
    // Elements of arrays.
    refused(
        "[ e e ] { 1 add pop } forall",
        "`add` needs a number or 2D vector or vector, not a half-edge [add]",
    );
    refused(
        "[ e v ] { facedegree pop } forall [ v v ] { edgemate pop } forall",
        "`edgemate` needs a half-edge, not a vertex [edgemate]",
    );
    refused(
        "[ 1 2 ] { 2 mul } map 0 get edgemate pop",
        "`edgemate` needs a half-edge, not a number [edgemate]",
    );
    refused("[ 1 ] { } map 0 get edgemate pop", "`edgemate` needs a half-edge, not a number [edgemate]");
    refused("[ 1 ] { pop } map pop", "the procedure of this map must leave one value [map]");
    accepted("usereg [ 1 ] !a :a e append :a { pop } forall");
    // Dictionaries.
    refused(
        "dict begin /n 1 def n edgemate pop end",
        "`edgemate` needs a half-edge, not a number [edgemate]",
    );
    refused(
        "dict begin /f { 1 } def f edgemate pop end",
        "`edgemate` needs a half-edge, not a number [edgemate]",
    );
    refused(
        "usereg dict !d :d /x v put :d.x edgemate pop",
        "`edgemate` needs a half-edge, not a vertex [edgemate]",
    );
    refused("dict { 1 } eval edgemate pop", "`edgemate` needs a half-edge, not a number [edgemate]");
    accepted("dict begin /n 1 def /n e def n edgemate pop end");
    // What is left, also when the bottom of the stack is not known.
    refused("[ 1 2 ] aload 5", "the action leaves at least 1 value on the stack; it must leave none [}]");
    // Procedures in registers.
    refused("usereg { 1 } !f :f edgemate pop", "`edgemate` needs a half-edge, not a number [edgemate]");
    accepted("usereg [ { e } ] 0 get exec edgemate pop");
    accepted("e 1 throw");
}

#[test]
fn rules_that_may_never_end() {
    warned(
        "rule A { e } action { e dup vertexCW e vertexpos makeEV pop }",
        &[
            "1:6 rule A may never end: its action changes nothing that its pattern looks at, so it matches at the same place again [A]",
        ],
    );
    warned(
        "rule A { e } where { 1 } action { }",
        &[
            "1:6 rule A may never end: its action changes nothing that its pattern looks at, so it matches at the same place again [A]",
        ],
    );
    // What is taken off another element than the one that the pattern asks about does not end it.
    for text in [
        "input t \"h\" rule A { e(t) mate> m } action { m \"t\" attrdel }",
        "input t \"h\" rule A { e(t) face> f } action { f \"t\" attrdel }",
        "input t \"h\" rule A { e(t) source> v } action { v dup \"t\" attrdel pop }",
    ] {
        warned(
            text,
            &[
                "1:18 rule A may never end: its action changes nothing that its pattern looks at, so it matches at the same place again [A]",
            ],
        );
    }
    warned("input t \"h\" rule A { e(t) mate> m } action { m edgemate \"t\" attrdel }", &[]);
    warned("rule A { e } not { e(x) } action { e \"x\" 1 attrset }", &[]);
    warned("rule A { e } where { e facedegree 5 lt } action { e dup vertexCW e vertexpos makeEV pop }", &[]);
    warned(
        "input go \"h\" rule A { e(go) } action { e \"go\" attrdel e 2 faceCCW edgemate \"go\" 1 attrset }",
        &["1:19 rule A may never end: it makes what its own pattern needs, without a condition [A]"],
    );
    warned(
        "input x \"h\" rule A { e(x) } action { e \"x\" attrdel e \"y\" 1 attrset } rule B { e(y) } action { e \"y\" attrdel e \"x\" 1 attrset }",
        &["1:18 rules A, B may never end: each makes what the next one needs, without a condition [A]"],
    );
    warned(
        "rule A { e(t) } action { e \"t\" attrdel { } loop }",
        &["1:44 this loop never ends: nothing in its procedure is an `exit` [loop]"],
    );
}

#[test]
fn patterns_that_never_match() {
    let delete = "action { e \"t\" attrdel }";
    let never =
        |pattern: &str, expected: &str| warned(&format!("rule A {{ {pattern} }} {delete}"), &[expected]);
    never("e(t=1, t=2)", "1:17 rule A never matches: no value of `t` passes all of its tests [t=2]");
    never("e(t<1, t>1)", "1:17 rule A never matches: no value of `t` passes all of its tests [t>1]");
    never("e(t=\"a\", t>1)", "1:19 rule A never matches: no value of `t` passes all of its tests [t>1]");
    warned(&format!("rule A {{ e(t>=1, t<=1, t!=2) }} {delete}"), &[]);
    never(
        "e(t) mate> m mate> n",
        "1:23 rule A never matches: `e` and `n` are the same element here, but different nodes of a pattern are different elements [mate>]",
    );
    never(
        "e(t) faceCCW> a faceCW> b",
        "1:26 rule A never matches: `e` and `b` are the same element here, but different nodes of a pattern are different elements [faceCW>]",
    );
    never(
        "e(t) target> v  e faceCCW> n source> w",
        "1:39 rule A never matches: `v` and `w` are the same element here, but different nodes of a pattern are different elements [source>]",
    );
    never(
        "e(t) source> v  e target> v",
        "1:28 rule A never matches: an edge would begin and end at the same vertex [target>]",
    );
    never(
        "e(t, boundary) faceCCW> n",
        "1:25 rule A never matches: `e` and `n` belong to one face, but only one of them asks for `boundary` [faceCCW>]",
    );
    never(
        "e(t, boundary) mate> n(boundary)",
        "1:25 rule A never matches: `e` and `n` cannot both lie outside: an edge has a face [mate>]",
    );
    warned(&format!("rule A {{ e(t) vertexCW> a vertexCCW> e }} {delete}"), &[]);
    warned(
        &format!("rule A {{ e(t) faceCCW> n }} not {{ e faceCCW> n }} {delete}"),
        &["1:28 rule A never matches: its pattern holds what this `not` excludes [not]"],
    );
}

#[test]
fn attributes_that_nobody_brings_or_takes_away() {
    warned(
        "rule A { e(cut) } action { e \"cut\" attrdel }",
        &[
            "1:12 this never matches: no rule sets the attribute `cut`; declare it if the caller does: input cut \"...\" [cut]",
        ],
    );
    warned("input cut \"places\" rule A { e(cut) } action { e \"cut\" attrdel }", &[]);
    warned(
        "rule A { e span> f } action { e \"span\" f linkdel }",
        &[
            "1:12 this never matches: no rule sets the link `span`; declare it if the caller does: input span \"...\" [span>]",
        ],
    );
    warned(
        "rule A { e(t) } action { e \"t\" attrdel e \"n\" 1 attrset } rule B { e(n=2) } action { e \"n\" attrdel }",
        &["1:69 this never matches: the rules give other values to `n` only [n=2]"],
    );
    warned(
        "rule A { e(color=\"red\") faceCCW> f } action { e f makeEF pop }",
        &[
            "1:12 no rule takes `color` away: it stays on the mesh as if nothing had handled it [color=\"red\"]",
        ],
    );
    // Names that the check cannot know may be any.
    warned("rule A { e(cut) } action { e \"cut\" attrdel [ \"a\" \"b\" ] { e exch 1 attrset } forall }", &[]);
    warned(
        "parameter w 1 range 0 2 unit length \"h\" rule A { e(t) } action { e \"t\" attrdel }",
        &["1:11 no rule uses the parameter `w` [w]"],
    );
}

#[test]
fn the_project_s_rules_have_no_warnings_and_drawings() {
    for path in common::rule_sets() {
        let set = RuleSet::load(&path).expect("rules");
        let warnings: Vec<String> = set.warnings().iter().map(ToString::to_string).collect();
        assert!(warnings.is_empty(), "{}", warnings.join("\n"));
        for rule in set.rules() {
            let svg = rule_svg(&set, rule, None);
            // Conditions and attributes that a pattern does not name are those of the case.
            let case = Case::load(
                &path
                    .with_file_name("../tests/rules")
                    .join(set.name().trim_end_matches(".rules"))
                    .join(format!("{}.case", rule.name)),
            );
            if let Ok(case) = &case {
                assert!(!rule_svg(&set, rule, Some(case)).contains("the action needs more"), "{}", rule.name);
            }
            assert!(svg.starts_with("<svg ") && svg.ends_with("</svg>\n") && !svg.contains("NaN"), "{svg}");
        }
    }
}

/// Lines of new edges (bolder), vertices, marks and links in a drawing of the first rule.
fn drawn(text: &str) -> [usize; 4] {
    let set = rules(text);
    let svg = rule_svg(&set, &set.rules()[0], None);
    ["stroke-width:2.6", "<circle", "stroke:#c8102e", "<path d=\"M0 0L10"]
        .map(|part| svg.matches(part).count())
}

#[test]
fn drawings_show_what_the_rule_does() {
    // The paper's example: a quad with a mark, left and right; the diagonal is new.
    let example = "rule Example { e1(color=\"red\") faceCCW> e2 faceCCW> e3 faceCCW> e4 faceCCW> e1 } action { e1 e3 makeEF pop }";
    assert_eq!(drawn(example)[..3], [1, 8, 2]);
    // An open pattern becomes a quad.
    assert_eq!(drawn("rule A { e(t) } action { e \"t\" attrdel e e 2 faceCCW makeEF pop }")[..2], [1, 8]);
    // Two faces side by side: six vertices, twice.
    assert_eq!(drawn("rule A { e(t) mate> m faceCCW> n } action { e \"t\" attrdel }")[1], 12);
    // A face round a vertex: three quads round their common vertex have seven vertices.
    assert_eq!(
        drawn("rule A { a(t) vertexCW> b vertexCW> c vertexCW> a } action { a \"t\" attrdel }")[1],
        14
    );
    // The action fails on the drawing: it says why.
    let set = rules("rule A { e(t) } action { \"too narrow\" throw }");
    assert!(
        rule_svg(&set, &set.rules()[0], None)
            .contains("the action needs more: the script threw \"too narrow\"")
    );
    let set = rules("rule A { a(t) mate> b mate> c } action { a \"t\" attrdel }");
    assert!(rule_svg(&set, &set.rules()[0], None).contains("no drawing: "));
}

#[test]
fn the_program_tells_errors_from_warnings() {
    let folder = std::env::temp_dir().join(format!("welt-check-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    let run = |text: &str, json: bool| {
        let path = folder.join("r.rules");
        std::fs::write(&path, text).expect("a file");
        let mut command = Command::new(env!("CARGO_BIN_EXE_welt"));
        command.args(["rules", "check"]).arg(Path::new("r.rules")).current_dir(&folder);
        if json {
            command.arg("--json");
        }
        let output = command.output().expect("the program starts");
        (output.status.code(), String::from_utf8_lossy(&output.stdout).into_owned())
    };
    let clean = "rule A { e(t) } action { e \"t\" attrdel }";
    let warning = "rule A { e(t) } action { }";
    assert_eq!(run(clean, false), (Some(0), "r.rules: 1 rules, no errors, no warnings\n".to_owned()));
    assert_eq!(run(warning, false).0, Some(3));
    assert_eq!(run("rule A { e(t) } action { x }", false).0, Some(1));
    assert_eq!(run(clean, true), (Some(0), "[]\n".to_owned()));
    let (code, json) = run(warning, true);
    assert_eq!(code, Some(3));
    let found: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    assert_eq!(found[0]["severity"], "warning");
    assert_eq!((found[0]["line"].as_u64(), found[0]["column"].as_u64()), (Some(1), Some(6)));
    std::fs::remove_dir_all(&folder).expect("the folder was made above");
}
