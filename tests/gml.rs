//! The script language: every word, its errors, and hostile scripts.

use glam::DVec3;
use proptest::prelude::*;
use welt::gml::{Allowance, Budget, Environment, Fault, Machine, Scope, Source, Stop, Strings, compile};
use welt::mesh::{Domain, Mesh, Polygons, VertexId};

/// A cube of side 2 round the origin, its faces seen from outside counter-clockwise.
fn cube() -> Mesh {
    let positions = (0..8)
        .map(|i| DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2)) * 2.0 - DVec3::ONE)
        .collect();
    let faces: [&[u32]; 6] =
        [&[0, 2, 3, 1], &[4, 5, 7, 6], &[0, 1, 5, 4], &[2, 6, 7, 3], &[0, 4, 6, 2], &[1, 3, 7, 5]];
    Mesh::from_polygons(&Polygons::new(positions, &faces)).expect("a cube is a mesh")
}

/// What a run gives: the stack as text, or the message and the word it is about.
fn run_on(mesh: &mut Mesh, text: &str) -> Result<String, String> {
    // e runs from vertex 0 to vertex 1 (in the face y = -1), v is vertex 7.
    let e = mesh.find_half_edge(VertexId(0), VertexId(1)).expect("the edge exists");
    let nodes = [("e".to_owned(), Domain::HalfEdge), ("v".to_owned(), Domain::Vertex)];
    let scope = Scope { nodes: &nodes, parameters: &["width".to_owned()], read_only: false };
    let source = Source::new("test", text);
    let mut strings = Strings::default();
    let program = compile(&source, &scope, &mut strings).map_err(|errors| {
        errors.iter().map(|e| format!("{} [{}]", e.message, e.word)).collect::<Vec<_>>().join("; ")
    })?;
    let allowance = Allowance { steps: 1_000_000, edits: 100_000, elements: 200_000, depth: 1000 };
    let mut machine = Machine::new(&strings);
    let mut budget = Budget::new(allowance, None, None);
    let mut environment =
        Environment { mesh, nodes: &[e.0, 7], parameters: &[0.25], examples: None, budget: &mut budget };
    machine.run(&program, &mut environment).map_err(|failure| match failure.fault {
        Fault::Error(message) => format!("{message} [{}]", program.word(failure.op)),
        Fault::Thrown(value) => format!("threw {value}"),
        Fault::Stopped(Stop::Steps) => "too many steps".to_owned(),
        Fault::Stopped(_) => "stopped".to_owned(),
    })?;
    let shown: Vec<String> = machine
        .stack()
        .iter()
        .map(|value| match value {
            welt::gml::Value::Array(id) => {
                let elements: Vec<String> =
                    machine.array(*id).iter().map(|v| machine.show(v, mesh)).collect();
                format!("[{}]", elements.join(" "))
            }
            value => machine.show(value, mesh),
        })
        .collect();
    Ok(shown.join(" "))
}

fn run(text: &str) -> Result<String, String> {
    run_on(&mut cube(), text)
}

#[track_caller]
fn gives(text: &str, stack: &str) {
    assert_eq!(run(text).as_deref(), Ok(stack), "{text}");
}

#[track_caller]
fn fails(text: &str, message: &str) {
    assert_eq!(run(text), Err(message.to_owned()), "{text}");
}

#[test]
fn stack_words() {
    gives("1 2 pop", "1");
    gives("1 dup", "1 1");
    gives("1 2 exch", "2 1");
    gives("5 6 7 2 index", "5 6 7 5");
    gives("1 2 3 3 1 roll", "3 1 2");
    gives("1 2 3 3 -1 roll", "2 3 1");
    gives("1 2 3 4 3 2 roll", "1 3 4 2");
    gives("9 0 5 roll", "9");
    gives("1 2 clear", "");
    gives("7 8 count", "7 8 2");
    gives("1 mark 2 3 counttomark", "1 mark 2 3 2");
    gives("1 mark 2 3 cleartomark", "1");
    gives("width", "0.25");
    fails("pop", "the stack holds too few values [pop]");
    fails("1 exch", "the stack holds too few values [exch]");
    fails("1 1 index", "the stack holds too few values [index]");
    fails("1 -1 index", "this needs a number from 0, but finds -1 on the stack [index]");
    fails("1 2 3 1 roll", "the stack holds too few values [roll]");
    fails("cleartomark", "there is no mark on the stack [cleartomark]");
}

#[test]
fn arrays_and_dictionaries() {
    gives("[ 1 2 3 ]", "[1 2 3]");
    gives("[ 1 \"a\" /b (1,2,3) ]", "[1 \"a\" /b (1, 2, 3)]");
    gives("[ 5 6 7 ] 1 get", "6");
    gives("[ 5 6 7 ] -1 get", "7");
    gives("[ 5 6 7 ] 3 get", "5");
    gives("[ 5 6 7 ] dup 4 9 put", "[5 9 7]");
    gives("[ 5 ] dup 6 append", "[5 6]");
    gives("[ 5 6 ] length [ ] length", "2 0");
    gives("[ 5 6 ] aload", "5 6");
    gives("[ 5 6 7 ] reverse", "[7 6 5]");
    gives("[ 5 6 7 8 ] 3 2 subarray", "[8 5]");
    gives("[ ] 3 0 subarray", "[]");
    gives("[ 1 [ 2 3 ] [ ] 4 ] flatten", "[1 2 3 4]");
    gives("[ 1 2 ] dup copy dup 0 9 put", "[1 2] [9 2]");
    gives("dict dup /a 5 put dup /a get exch length", "5 1");
    gives("dict dup /a 5 put dup /a known exch /b known", "1 0");
    gives("dict begin /a 5 def 6 /b edef a b end", "5 6");
    gives("/a 5 def a", "5");
    gives("/f { 1 add } def 4 f", "5");
    gives("/f { 1 } def /f load", "procedure");
    gives("/a 5 def /a where exch pop /b where", "1 0");
    gives("dict dup /a 5 put /d exch def d.a", "5");
    gives("dict dup /a { 7 } put /d exch def d.a", "7");
    gives("usereg dict !d ;d /a 3 put :d.a", "3");
    gives("dict dup /a 1 put dup copy dup /a 2 put /a get exch /a get", "2 1");
    fails("[ ] 0 get", "the array is empty [get]");
    fails("[ 1 ] 0.5 get", "this needs a whole number, but finds 0.5 on the stack [get]");
    fails("5 0 get", "this needs an array or dictionary, but finds the number 5 on the stack [get]");
    fails("[ 1 ] 0 2 subarray", "the array has 1 elements, fewer than 2 [subarray]");
    fails("dict /a get", "the dictionary has no entry `a` [get]");
    fails("end", "`end` without its `begin` [end]");
    fails("a /a 5 def", "`a` is not defined here [a]");
}

#[test]
fn control_words() {
    gives("{ 1 2 } exec 5 exec", "1 2 5");
    gives("dict dup /a 4 put { a a } eval", "4 4");
    gives("1 { 5 } if 0 { 6 } if", "5");
    gives("1 { 5 } { 6 } ifelse 0 { 5 } { 6 } ifelse", "5 6");
    gives("0 3 { 2 add } repeat", "6");
    gives("1 1 3 { } for", "1 2 3");
    gives("3 -1 1 { } for", "3 2 1");
    gives("0 1 3 { } forx", "0 1 2");
    gives("0 { 1 add dup 5 eq { exit } if } loop", "5");
    gives("[ 1 2 3 ] { dup } forall", "1 1 2 2 3 3");
    gives("[ 1 2 3 ] { dup 2 eq { pop exit } if } forall", "1");
    gives("[ 1 2 ] [ 10 20 ] { add } twoforall", "11 22");
    gives("[ 1 2 3 ] { dup mul } map", "[1 4 9]");
    gives("[ 1 2 ] [ 5 6 ] { mul } twomap", "[5 12]");
    gives("[ 1 2 3 ] { dup 3 eq { exit } if } map", "[1 2]");
    gives("7 { 1 2 /oops throw } { } catch", "7 /oops");
    gives("{ 5 } { pop 6 } catch", "5");
    gives("{ { 1 throw } { 1 add throw } catch } { 10 mul } catch", "20");
    gives("0 2 { 3 { 1 add } repeat } repeat", "6");
    fails("1 throw", "threw 1");
    fails("\"no way\" throw", "threw \"no way\"");
    fails("exit", "`exit` outside of a loop [exit]");
    fails("1 2 if", "this needs a procedure, but finds the number 2 on the stack [if]");
    fails("[ 1 ] [ 1 2 ] { } twoforall", "the arrays have 1 and 2 elements [twoforall]");
    fails("[ 1 ] { pop } map", "the procedure of this map must leave one value [}]");
    fails("0 0 5 { } for", "a step of 0 never gets from 0 to 5 [for]");
    fails("{ 1 } loop", "too many steps");
    fails(
        "/f { f } def f",
        "more than 1000 procedures and loops inside one another; end the recursion, or raise the limit [f]",
    );
    fails(
        "5 { pop 1 throw } { } catch",
        "a procedure under `catch` took values that were on the stack before it [throw]",
    );
}

#[test]
fn registers() {
    gives("usereg 5 !x :x :x", "5 5");
    gives("usereg { 5 } !f :f ;f", "5 procedure");
    gives("usereg 1 !x { 2 !x } exec :x", "2");
    gives("usereg 1 !x { usereg 2 !x } exec :x", "1");
    // A recursive procedure keeps its own registers.
    gives("/fact { usereg !n :n 1 le { 1 } { :n 1 sub fact :n mul } ifelse } def 5 fact", "120");
    gives("usereg 1 !x 2 { usereg 7 !x :x } repeat :x", "7 7 1");
    fails("5 !x", "register `x` needs `usereg` at the beginning of the script [!x]");
    fails("usereg :x", "register `x` is used before anything is stored in it [:x]");
    fails("usereg :x 5 !x", "register `x` is used before anything is stored in it [:x]");
    fails("usereg 0 { 5 !x } if :x", "this register is used before anything is stored in it [:x]");
    fails("usereg usereg", "`usereg` stands twice in one procedure [usereg]");
}

#[test]
fn numbers() {
    gives("1 2 add 5 3 sub 4 3 mul 9 2 div", "3 2 12 4.5");
    gives("7 3 mod -7 3 mod", "1 2");
    gives("5 neg -4 abs 9 sqrt 2 10 pow", "-5 4 3 1024");
    gives("0 exp 1 ln 1.5 floor 1.2 ceiling 1.6 round", "1 0 1 2 2");
    gives("2 3 min 2 3 max", "2 3");
    gives("90 sin 0 cos 0 tan 0 asin 1 acos", "1 1 0 0 0");
    gives("1 1 atan 1 0 atan -1 0 atan", "45 90 -90");
    gives("1 1 eq 1 2 eq \"a\" \"a\" eq \"a\" /a eq [ 1 2 ] [ 1 2 ] eq e e eq e v ne", "1 0 1 0 1 1 1");
    gives("1 2 lt 2 2 le 1 2 gt 2 2 ge", "1 1 0 1");
    gives("1 0 and 1 0 or 0 not 5 not", "0 1 1 0");
    gives("-1.5e2 +.5", "-150 0.5");
    fails("1 0 div", "division by zero [div]");
    fails("1 0 mod", "division by zero [mod]");
    fails("-1 sqrt", "the result is not a finite number [sqrt]");
    fails("1000 exp", "the result is not a finite number [exp]");
    fails("1 \"a\" add", "`add` cannot take the number 1 and the text \"a\" [add]");
    fails("1 e lt", "this needs a number, but finds edge 0 -> 1 on the stack [lt]");
}

#[test]
fn vectors() {
    gives("(1,2) (3,4,5)", "(1, 2) (3, 4, 5)");
    gives("1 2 vector2 3 4 5 vector3", "(1, 2) (3, 4, 5)");
    gives("(1,2,3) getX (1,2,3) getY (1,2,3) getZ", "1 2 3");
    gives("(1,2,3) (4,5,6) add (4,5,6) (1,2,3) sub", "(5, 7, 9) (3, 3, 3)");
    gives("(1,2,3) (4,5,6) mul 2 (1,2) mul (2,4) 2 div", "32 (2, 4) (1, 2)");
    gives("(3,4) abs (1,-2,3) neg", "5 (-1, 2, -3)");
    gives("(1,0,0) (0,1,0) cross", "(0, 0, 1)");
    gives("(1,1,1) (1,4,5) dist (0,0) (3,4) dist", "5 5");
    gives("(0,0,5) normalize (3,0) normalize", "(0, 0, 1) (1, 0)");
    gives("(1,0,0) (0,0,1) 180 rot_vec getX", "-1");
    gives("(0,0,0) (2,4,6) 0.5 lerp 1 3 0.25 lerp (0,0) (2,2) 0.5 lerp", "(1, 2, 3) 1.5 (1, 1)");
    gives("(1,0,0) (0,1,0) (2,3) planemul", "(2, 3, 0)");
    gives("(5,6,7) (0,0,1) (2,0,0) project_ptline", "(5, 0, 1)");
    gives("(5,6,7) (0,0,1) (0,0,3) project_ptplane", "(5, 6, 1)");
    fails("(0,0,0) normalize", "a vector of length zero has no direction [normalize]");
    fails("(1,2) getZ", "this needs a vector, but finds the 2D vector (1, 2) on the stack [getZ]");
    fails("(1,2) (1,2,3) add", "`add` cannot take the 2D vector (1, 2) and the vector (1, 2, 3) [add]");
}

#[test]
fn walks_and_queries_on_a_cube() {
    // e runs 0 -> 1 in the face (0 1 5 4), whose normal is -y.
    gives("e vertexpos e target vertexpos", "(-1, -1, -1) (1, -1, -1)");
    gives("e edgemate source vertexpos", "(1, -1, -1)");
    gives("e faceCCW vertexpos e faceCW vertexpos", "(1, -1, -1) (-1, -1, 1)");
    gives("e 2 faceCCW vertexpos e 4 faceCCW e eq", "(1, -1, 1) 1");
    gives("e 2 faceCCW e 2 faceCW eq", "1");
    gives("e vertexCW e edgemate faceCCW eq e vertexCCW e faceCW edgemate eq", "1 1");
    gives("e 3 vertexCW e eq e 3 vertexCCW e eq", "1 1");
    gives("e vertexCW vertexCCW e eq", "1");
    gives("e edgedirection e facenormal e facemidpoint", "(1, 0, 0) (0, -1, 0) (0, -1, 0)");
    gives("v vertexnormal (1,1,1) normalize dist 0.000001 lt", "1");
    gives("e facedegree e valence e face facedegree v valence", "4 3 4 3");
    gives("e isboundary v isboundary e face isboundary", "0 0 0");
    gives("e e edgemate sameEdge e e faceCCW sameEdge", "1 0");
    gives("e e faceCCW sameFace e e edgemate sameFace", "1 0");
    gives("e e vertexCW sameVertex e e faceCCW sameVertex", "1 0");
    gives("e sharpness e issharp e 2.5 setsharpness e edgemate sharpness e issharp", "0 0 2.5 1");
    gives("v 3 setsharpness v sharpness e source sharpness", "3 0");
    fails("5 faceCCW", "the stack holds too few values [faceCCW]");
    fails("e -1 faceCCW", "this needs a number from 0, but finds -1 on the stack [faceCCW]");
    fails("v edgemate", "this needs a half-edge, but finds vertex 7 on the stack [edgemate]");
    fails("e -1 setsharpness", "a sharpness of -1 is out of range; it is 0 (smooth) or more [setsharpness]");
}

#[test]
fn euler_operators_and_moves() {
    let mut mesh = cube();
    // Split an edge, split a face from the new vertex, and take both back.
    assert_eq!(run_on(&mut mesh, "e dup vertexCW (0,-1,-1) makeEV pop").as_deref(), Ok(""));
    assert_eq!(mesh.counts(), [9, 13, 6]);
    mesh.validate_control_mesh().expect("a control mesh");
    let mut mesh = cube();
    assert_eq!(run_on(&mut mesh, "e e 2 faceCCW makeEF killEF").as_deref(), Ok(""));
    assert_eq!(run_on(&mut mesh, "e (0,-1,0) makeEVone killEV").as_deref(), Ok(""));
    assert_eq!(
        run_on(&mut mesh, "(0,0,0) (1,0,0) makeVEFS dup vertexpos exch killVEFS").as_deref(),
        Ok("(1, 0, 0)")
    );
    assert_eq!(mesh.counts(), [8, 12, 6]);
    assert_eq!(run_on(&mut mesh, "e (0,0,0) moveV e vertexpos").as_deref(), Ok("(0, 0, 0)"));
    assert_eq!(
        run_on(&mut mesh, "e (0,0,1) moveE e vertexpos e target vertexpos").as_deref(),
        Ok("(0, 0, 1) (1, -1, 0)")
    );
    assert_eq!(
        run_on(&mut mesh, "e (1,0,0) moveF e vertexpos e facemidpoint").as_deref(),
        Ok("(1, 0, 1) (1.25, -0.75, 0.75)")
    );
    fails(
        "e e makeEF",
        "makeEF needs two different vertices; edge 0 -> 1 and edge 0 -> 1 both start at vertex 0 [makeEF]",
    );
    fails("e killVEFS", "killVEFS needs a shell of a single edge; edge 0 -> 1 has neighbours [killVEFS]");
    fails("e (0,0,0) makeEVone dup killEV vertexpos", "this half-edge was removed [vertexpos]");
}

#[test]
fn a_face_is_tiled() {
    // A face of the cube becomes five quads round a smaller one; the corners are vertices, the rest numbers of points.
    let script = "usereg [ 0 1 3 { !i e :i faceCCW source } for ] !V
        e [ 0 1 3 { !i :V :i get vertexpos e facemidpoint 0.5 lerp } for ]
        [ 0 1 3 { !i [ :V :i get :V :i 1 add get :i 1 add 4 mod :i ] } for [ 0 1 2 3 ] ] makeFaces length";
    let mut mesh = cube();
    assert_eq!(run_on(&mut mesh, script).as_deref(), Ok("4"));
    assert_eq!(mesh.counts(), [12, 20, 10]);
    mesh.validate_control_mesh().expect("a control mesh");
    // A face that is left out, a point that is not used, what is no corner.
    let misfit = "does not fit to the rest; the faces must cover the old face once, counter-clockwise, and use every point [makeFaces]";
    let corners = "e source e 1 faceCCW source e 2 faceCCW source e 3 faceCCW source";
    for (points, faces, face) in [
        ("", format!("[ [ {corners} 0 ] ]"), 0),
        ("(0,0,0)", format!("[ [ {corners} ] ]"), 0),
        ("(0,0,0)", "[ [ e source e 1 faceCCW source 0 ] ]".to_owned(), 0),
        ("", String::from("[ [ e source e 2 faceCCW source e 1 faceCCW source ] ]"), 0),
    ] {
        let message = format!("makeFaces: face {face} of the tiling, counted from 0, {misfit}");
        fails(&format!("e [ {points} ] {faces} makeFaces"), &message);
    }
    fails("e [ 1 ] [ ] makeFaces", "makeFaces needs an array of points [makeFaces]");
    fails(
        "e [ ] [ [ 0.5 ] ] makeFaces",
        "makeFaces needs an array of faces, each an array of vertices and of numbers of points [makeFaces]",
    );
}

#[test]
fn attributes_and_links() {
    gives("e \"n\" 5 attrset e \"n\" attrget e /n attrhas e \"m\" attrhas", "5 1 0");
    gives("e /s \"red\" attrset e /s attrget \"red\" eq", "1");
    gives("e /p (1,2,3) attrset e /p attrget", "(1, 2, 3)");
    gives("e /a [ 1 2 3 ] attrset e /a attrget", "[1 2 3]");
    gives("e /n 5 attrset e /n attrdel e /n attrhas e /n attrdel", "0");
    gives("e /span v linkset e /span linkhas e /span linkget v eq v /span linkhas", "1 1 0");
    gives("e /span v linkset e /span v linkdel e /span linkhas", "0");
    fails("e /n attrget", "edge 0 -> 1 has no attribute `n` [attrget]");
    fails(
        "e /n [ e ] attrset",
        "an attribute holds a number, a text, a vector or an array of numbers, not array of 1; use a link for a node [attrset]",
    );
    fails("e /span linkget", "edge 0 -> 1 has no links `span`, one is needed [linkget]");
    fails(
        "e /span v linkset e /span e linkset e /span linkget",
        "edge 0 -> 1 has 2 links `span`, one is needed [linkget]",
    );
}

#[test]
fn throw_takes_back_changes_of_the_mesh() {
    let mut mesh = cube();
    let before = mesh.to_polygons();
    let script = "{ e e 2 faceCCW makeEF pop e /n 5 attrset 1 throw } { pop } catch e /n attrhas";
    assert_eq!(run_on(&mut mesh, script).as_deref(), Ok("0"));
    assert_eq!(mesh.to_polygons(), before);
}

#[test]
fn mistakes_of_spelling() {
    fails("1 2 ad", "unknown word `ad`; did you mean `add`? [ad]");
    fails("1 }", "`}` without its `{` [}]");
    fails("{ 1", "`{` without its `}` [{]");
    fails("[ 1", "`[` without its `]` in the same procedure [[]");
    fails("[ { ] }", "`[` without its `]` in the same procedure [[]; `]` without its `[` []]");
    fails("\"abc", "this text has no closing quote on its line [\"abc]");
    fails(
        "(1,a)",
        "a vector is written (x, y) or (x, y, z) with numbers [(1,]; unknown word `a` [a]; `)` has no meaning here [)]",
    );
    fails("12x", "`12x` is not a number [12x]");
    fails("1e999", "this number is too large [1e999]");
    fails("/ 1", "a name must follow `/` [/]");
}

#[test]
fn many_nested_procedures_do_not_overflow() {
    let text = format!("{}{}", "{ ".repeat(200_000), "} ".repeat(200_000));
    assert_eq!(run(&text).as_deref(), Ok("procedure"));
    let text = "usereg [ ] !a 100000 { [ :a ] !a } repeat";
    assert_eq!(run(text).as_deref(), Ok(""));
}

const TOKENS: &[&str] = &[
    "1",
    "0",
    "-1",
    "3",
    "0.5",
    "\"a\"",
    "/a",
    "/b",
    "(1,2)",
    "(1,2,3)",
    "[",
    "]",
    "{",
    "}",
    "usereg",
    "!x",
    ":x",
    ";x",
    "e",
    "v",
    "width",
    "dup",
    "exch",
    "pop",
    "index",
    "roll",
    "get",
    "put",
    "append",
    "aload",
    "copy",
    "flatten",
    "subarray",
    "dict",
    "begin",
    "end",
    "def",
    "load",
    "exec",
    "eval",
    "if",
    "ifelse",
    "repeat",
    "for",
    "forx",
    "loop",
    "exit",
    "forall",
    "map",
    "twomap",
    "catch",
    "throw",
    "add",
    "mul",
    "div",
    "mod",
    "eq",
    "not",
    "lerp",
    "cross",
    "edgemate",
    "faceCCW",
    "vertexCW",
    "source",
    "face",
    "vertexpos",
    "facenormal",
    "makeEV",
    "makeEF",
    "makeEVone",
    "makeFaces",
    "makeVEFS",
    "killEF",
    "killEV",
    "killVEFS",
    "moveV",
    "moveF",
    "setsharpness",
    "attrset",
    "attrget",
    "attrdel",
    "linkset",
    "linkget",
    "linkdel",
    "count",
    "mark",
    "cleartomark",
    "reverse",
    "length",
];

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(2000) })]

    /// Whatever a script holds: it ends, nothing panics, and the mesh stays a mesh that can be rolled back.
    #[test]
    fn token_soup(tokens in prop::collection::vec(prop::sample::select(TOKENS), 0..60)) {
        let mut mesh = cube();
        let before = mesh.to_polygons();
        let checkpoint = mesh.begin();
        let _ = run_on(&mut mesh, &tokens.join(" "));
        prop_assert!(mesh.validate().is_ok());
        mesh.rollback(checkpoint);
        prop_assert_eq!(mesh.to_polygons(), before);
    }

    #[test]
    fn byte_soup(text in "\\PC{0,80}|[ -~\n]{0,80}") {
        let _ = run(&text);
    }
}
