use welt::grammar::RuleSet;
#[test]
fn loads() {
    match RuleSet::load(std::path::Path::new("/tmp/gram_rules/linear.rules")) {
        Ok(r) => println!("{} rules", r.rules().len()),
        Err(e) => println!("{e}"),
    }
    let text = "rule A { e(x faceCCW> f } action { e1 f pop makeEF 1 }\nrule A { a spam> b } not { c mate> d } where { a b } action { !x usereg :y \"abc }\nparameter p 5 range 1 2 unit u \"h\"\nparametr q\nrule B { a source> b faceCCW> c } action { lerpp }";
    println!("{}", RuleSet::parse("bad.rules", text, &|_| None).unwrap_err());
}
