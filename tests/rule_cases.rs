//! The before/after cases of the rules in `rules/`, and what is said about cases that are wrong.

use crate::common;

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use welt::grammar::{Case, RuleSet};

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

/// Files and folders in `folder`, by name.
fn entries(folder: &Path) -> Vec<PathBuf> {
    let mut entries: Vec<PathBuf> = std::fs::read_dir(folder)
        .unwrap_or_else(|error| panic!("{}: {error}", folder.display()))
        .map(|entry| entry.expect("an entry").path())
        .collect();
    entries.sort();
    entries
}

#[test]
fn every_case_passes_and_every_rule_has_one() {
    let mut failures = Vec::new();
    let mut shown: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for folder in entries(&root().join("tests/rules")) {
        let set = folder.file_name().expect("a name").to_string_lossy().into_owned();
        for path in entries(&folder) {
            assert_eq!(path.extension().and_then(|e| e.to_str()), Some("case"), "{}", path.display());
            match Case::load(&path).and_then(|case| case.check().map(|()| case)) {
                Ok(case) => {
                    shown.entry(set.clone()).or_default().extend(case.fired().map(str::to_owned));
                }
                Err(error) => failures.push(format!("{}: {error}", path.display())),
            }
        }
    }
    assert!(failures.is_empty(), "\n{}\n", failures.join("\n\n"));
    for path in common::rule_sets() {
        let set = path.file_stem().expect("a name").to_string_lossy().into_owned();
        let rules = RuleSet::load(&path).expect("rules");
        let shown = shown.remove(&set).unwrap_or_default();
        let without: Vec<&str> = rules
            .rules()
            .iter()
            .map(|rule| rule.name.as_str())
            .filter(|name| !shown.contains(*name))
            .collect();
        assert!(without.is_empty(), "no case in tests/rules/{set} shows {}", without.join(", "));
    }
}

/// A case of one quad, with `after` and the rest as given.
fn case(name: &str, text: &str) -> String {
    let folder = std::env::temp_dir().join(format!(
        "welt-cases-{}-{:?}",
        std::process::id(),
        std::thread::current().id()
    ));
    std::fs::create_dir_all(&folder).expect("a folder");
    let rules =
        "rule Cut { e(go) faceCCW> f faceCCW> g } action { e \"go\" attrdel e g makeEF \"new\" 1 attrset }
rule Stop { e(stop) } action { \"no way\" throw }";
    std::fs::write(folder.join("cut.rules"), rules).expect("a file");
    let path = folder.join(name);
    std::fs::write(&path, text).expect("a file");
    let result = match Case::load(&path).and_then(|case| case.check()) {
        Ok(()) => "passed".to_owned(),
        Err(error) => error.to_string().replace(&*folder.to_string_lossy(), "."),
    };
    std::fs::remove_dir_all(&folder).expect("the folder was made above");
    result
}

const QUAD: &str = "rules \"cut.rules\"\nbefore\nv A 0 0\nv B 1 0\nv C 1 1\nv D 0 1\nf A B C D\n";

#[test]
fn a_case_passes_only_when_everything_agrees() {
    let good = format!("{QUAD}h A B go=1\nafter\nf A B C\nf A C D\nh C A new=1\nfired Cut 1\n");
    assert_eq!(case("good", &good), "passed");
    let wrong = |from: &str, to: &str| case("wrong", &good.replace(from, to));
    let differs = |lines: &str| format!("the result differs (- expected, + found)\n{lines}");
    assert_eq!(wrong("fired Cut 1", "fired"), differs("- fired \n+ fired Cut 1"));
    assert_eq!(wrong("fired Cut 1", "fired Cut 2"), differs("- fired Cut 2\n+ fired Cut 1"));
    assert_eq!(wrong("h C A new=1", "h C A new=1.1"), differs("- h C A new=1.1\n+ h C A new=1"));
    assert_eq!(wrong("h C A new=1\n", ""), differs("+ h C A new=1"));
    assert_eq!(wrong("h C A", "h A C"), differs("- h A C new=1\n+ h C A new=1"));
    assert_eq!(wrong("h C A new=1", "h C A new=1 l> A"), differs("- h C A l> A"));
    assert_eq!(wrong("fired", "crease A C 2\nfired"), differs("- crease A C 2"));
    assert_eq!(
        wrong("f A B C\nf A C D\nh C A new=1", "v B 1 0.1\nf A B C\nf A C D\nh C A new=1"),
        differs("- v B 1 0.1 0\n+ v new1 1 0 0\n- f A B C\n+ f A new1 C")
    );
    // A face may begin anywhere, but not turn round.
    assert_eq!(wrong("f A B C\n", "f C A B\n"), "passed");
    assert_eq!(wrong("f A B C\n", "f C B A\n"), differs("+ f A B C\n- f A C B"));
}

#[test]
fn failures_of_rules_can_be_expected() {
    let stop = |end: &str| case("stop", &format!("{QUAD}h A B stop=1\n{end}\n"));
    assert_eq!(stop("fails \"no way\""), "passed");
    assert!(stop("fails \"other\"").starts_with(
        "the rules were to fail with a message that holds \"other\", but with this one: rule Stop failed"
    ));
    assert!(stop("after\nf A B C D\nfired").starts_with("the rules failed: rule Stop failed"));
    assert_eq!(
        case("stop", &format!("{QUAD}fails \"x\"")),
        "the rules were to fail with a message that holds \"x\", but they ran to their end"
    );
}

#[test]
fn mistakes_in_cases_have_a_place() {
    let wrong = |text: &str| case("wrong.case", text).lines().take(2).collect::<Vec<_>>().join("");
    let at = |message: &str, place: &str| format!("error: {message} --> ./wrong.case:{place}");
    assert_eq!(wrong(&format!("{QUAD}f A B X")), at("there is no vertex `X` here", "8:7"));
    assert_eq!(wrong(&format!("{QUAD}h A C go=1")), at("no face has `A C`", "8:1"));
    assert_eq!(wrong(&format!("{QUAD}h A B go=")), at("expected a number", "8:10"));
    assert_eq!(wrong(&format!("{QUAD}h A B go=1 l>")), at("expected the vertices of an element", "8:14"));
    assert_eq!(wrong(&format!("{QUAD}v A 0 0")), at("vertex `A` is there twice", "8:3"));
    assert_eq!(wrong(&format!("{QUAD}f A B")), at("a face has three vertices or more", "8:1"));
    let flipped = wrong(&format!("{QUAD}f A B C\nafter\nfired"));
    assert!(
        flipped.contains("(vertices and faces are counted from 0, line by line) --> ./wrong.case:2:1"),
        "{flipped}"
    );
    assert_eq!(wrong(&format!("only Nothing\n{QUAD}fired")), at("the file has no rule `Nothing`", "1:6"));
    assert_eq!(wrong("v A 0 0"), at("elements stand below `before` or `after`", "1:1"));
    assert!(wrong("w").contains("`w` has no meaning here; a line begins with rules, only"), "{}", wrong("w"));
    assert!(case("wrong.case", QUAD).contains("say which rules are applied: fired NAME COUNT"));
    assert!(case("wrong.case", &format!("{QUAD}fired")).contains("the mesh after the rules is missing"));
    assert!(case("wrong.case", "before\nfired").contains("a case names its rules"));
}
