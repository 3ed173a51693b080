//! The words of the language: names, what they take from the stack and what they leave.

use super::kind::Kinds;

/// What a word leaves on the stack.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Gives {
    /// Always these, the top one last.
    Fixed(&'static [Kinds]),
    /// It depends on the values; `takes` is then what is needed at least.
    Varies,
}

/// What a word does to the stack and to the mesh.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Signature {
    pub(crate) name: &'static str,
    /// The top one last.
    pub(crate) takes: &'static [Kinds],
    pub(crate) gives: Gives,
    /// Changes the mesh, so that a condition may not use it.
    pub(crate) edits: bool,
}

use Gives::Varies;
const fn gives(kinds: &'static [Kinds]) -> Gives {
    Gives::Fixed(kinds)
}

const ANY: Kinds = Kinds::ANY;
const NUM: Kinds = Kinds::NUMBER;
const VEC: Kinds = Kinds::VECTOR;
const VEC3: Kinds = Kinds::VEC3;
const LIN: Kinds = Kinds::LINEAR;
const ARR: Kinds = Kinds::ARRAY;
const DICT: Kinds = Kinds::DICT;
const PROC: Kinds = Kinds::PROCEDURE;
const NAME: Kinds = Kinds::NAME;
const KEY: Kinds = Kinds::KEY;
const NODE: Kinds = Kinds::NODE;
const HE: Kinds = Kinds::HALF_EDGE;
const PLACE: Kinds = Kinds::PLACE;
const SIDE: Kinds = Kinds::SIDE;
const VERT: Kinds = Kinds::VERTEX;
const FACE: Kinds = Kinds::FACE;
const BOX: Kinds = ARR.or(DICT);

macro_rules! words {
    ($($word:ident $name:literal $takes:expr => $gives:expr, $edits:literal;)*) => {
        /// A built-in word.
        #[derive(Clone, Copy, PartialEq, Eq, Debug)]
        pub(crate) enum Word { $($word),* }

        impl Word {
            /// All words, in the order of the reference.
            pub(crate) const ALL: &[Self] = &[$(Self::$word),*];

            pub(crate) fn signature(self) -> Signature {
                match self {
                    $(Self::$word => {
                        Signature { name: $name, takes: const { &$takes }, gives: const { $gives }, edits: $edits }
                    })*
                }
            }

            /// The word called `name`.
            pub(crate) fn named(name: &str) -> Option<Self> {
                match name {
                    $($name => Some(Self::$word),)*
                    _ => None,
                }
            }
        }
    };
}

words! {
    // Stack
    Pop "pop" [ANY] => gives(&[]), false;
    Dup "dup" [ANY] => Varies, false;
    Exch "exch" [ANY, ANY] => Varies, false;
    Index "index" [NUM] => Varies, false;
    Roll "roll" [NUM, NUM] => Varies, false;
    Clear "clear" [] => Varies, false;
    Count "count" [] => gives(&[NUM]), false;
    Mark "mark" [] => gives(&[Kinds::MARK]), false;
    ClearToMark "cleartomark" [] => Varies, false;
    CountToMark "counttomark" [] => gives(&[NUM]), false;
    OpenArray "[" [] => gives(&[Kinds::MARK]), false;
    CloseArray "]" [] => Varies, false;
    // Arrays and dictionaries
    Get "get" [BOX, NUM.or(KEY)] => gives(&[ANY]), false;
    Put "put" [BOX, NUM.or(KEY), ANY] => gives(&[]), false;
    Append "append" [ARR, ANY] => gives(&[]), false;
    Length "length" [BOX] => gives(&[NUM]), false;
    Aload "aload" [ARR] => Varies, false;
    Reverse "reverse" [ARR] => gives(&[ARR]), false;
    Subarray "subarray" [ARR, NUM, NUM] => gives(&[ARR]), false;
    Flatten "flatten" [ARR] => gives(&[ARR]), false;
    Copy "copy" [BOX] => gives(&[BOX]), false;
    Dict "dict" [] => gives(&[DICT]), false;
    Begin "begin" [DICT] => gives(&[]), false;
    End "end" [] => gives(&[]), false;
    Def "def" [NAME, ANY] => gives(&[]), false;
    Edef "edef" [ANY, NAME] => gives(&[]), false;
    Known "known" [DICT, KEY] => gives(&[NUM]), false;
    Where "where" [NAME] => Varies, false;
    Load "load" [NAME] => gives(&[ANY]), false;
    // Control
    Exec "exec" [ANY] => Varies, false;
    Eval "eval" [DICT, PROC] => Varies, false;
    If "if" [NUM, PROC] => Varies, false;
    IfElse "ifelse" [NUM, PROC, PROC] => Varies, false;
    Repeat "repeat" [NUM, PROC] => Varies, false;
    For "for" [NUM, NUM, NUM, PROC] => Varies, false;
    ForX "forx" [NUM, NUM, NUM, PROC] => Varies, false;
    Loop "loop" [PROC] => Varies, false;
    Exit "exit" [] => Varies, false;
    ForAll "forall" [ARR, PROC] => Varies, false;
    TwoForAll "twoforall" [ARR, ARR, PROC] => Varies, false;
    Map "map" [ARR, PROC] => Varies, false;
    TwoMap "twomap" [ARR, ARR, PROC] => Varies, false;
    Catch "catch" [PROC, PROC] => Varies, false;
    Throw "throw" [ANY] => Varies, false;
    // Arithmetic and comparison
    Add "add" [LIN, LIN] => gives(&[LIN]), false;
    Sub "sub" [LIN, LIN] => gives(&[LIN]), false;
    Mul "mul" [LIN, LIN] => gives(&[LIN]), false;
    Div "div" [LIN, NUM] => gives(&[LIN]), false;
    Mod "mod" [NUM, NUM] => gives(&[NUM]), false;
    Neg "neg" [LIN] => gives(&[LIN]), false;
    Abs "abs" [LIN] => gives(&[NUM]), false;
    Sqrt "sqrt" [NUM] => gives(&[NUM]), false;
    Pow "pow" [NUM, NUM] => gives(&[NUM]), false;
    Exp "exp" [NUM] => gives(&[NUM]), false;
    Ln "ln" [NUM] => gives(&[NUM]), false;
    Floor "floor" [NUM] => gives(&[NUM]), false;
    Ceiling "ceiling" [NUM] => gives(&[NUM]), false;
    Round "round" [NUM] => gives(&[NUM]), false;
    Min "min" [NUM, NUM] => gives(&[NUM]), false;
    Max "max" [NUM, NUM] => gives(&[NUM]), false;
    Sin "sin" [NUM] => gives(&[NUM]), false;
    Cos "cos" [NUM] => gives(&[NUM]), false;
    Tan "tan" [NUM] => gives(&[NUM]), false;
    Asin "asin" [NUM] => gives(&[NUM]), false;
    Acos "acos" [NUM] => gives(&[NUM]), false;
    Atan "atan" [NUM, NUM] => gives(&[NUM]), false;
    Eq "eq" [ANY, ANY] => gives(&[NUM]), false;
    Ne "ne" [ANY, ANY] => gives(&[NUM]), false;
    Lt "lt" [NUM, NUM] => gives(&[NUM]), false;
    Le "le" [NUM, NUM] => gives(&[NUM]), false;
    Gt "gt" [NUM, NUM] => gives(&[NUM]), false;
    Ge "ge" [NUM, NUM] => gives(&[NUM]), false;
    And "and" [NUM, NUM] => gives(&[NUM]), false;
    Or "or" [NUM, NUM] => gives(&[NUM]), false;
    Not "not" [NUM] => gives(&[NUM]), false;
    // Vectors
    Vector2 "vector2" [NUM, NUM] => gives(&[Kinds::VEC2]), false;
    Vector3 "vector3" [NUM, NUM, NUM] => gives(&[VEC3]), false;
    GetX "getX" [VEC] => gives(&[NUM]), false;
    GetY "getY" [VEC] => gives(&[NUM]), false;
    GetZ "getZ" [VEC3] => gives(&[NUM]), false;
    Cross "cross" [VEC3, VEC3] => gives(&[VEC3]), false;
    Dist "dist" [VEC, VEC] => gives(&[NUM]), false;
    Normalize "normalize" [VEC] => gives(&[VEC]), false;
    RotVec "rot_vec" [VEC3, VEC3, NUM] => gives(&[VEC3]), false;
    Lerp "lerp" [LIN, LIN, NUM] => gives(&[LIN]), false;
    PlaneMul "planemul" [VEC3, VEC3, Kinds::VEC2] => gives(&[VEC3]), false;
    ProjectLine "project_ptline" [VEC3, VEC3, VEC3] => gives(&[VEC3]), false;
    ProjectPlane "project_ptplane" [VEC3, VEC3, VEC3] => gives(&[VEC3]), false;
    // Walks and queries
    EdgeMate "edgemate" [HE] => gives(&[HE]), false;
    FaceCcw "faceCCW" [HE.or(NUM)] => Varies, false;
    FaceCw "faceCW" [HE.or(NUM)] => Varies, false;
    VertexCcw "vertexCCW" [HE.or(NUM)] => Varies, false;
    VertexCw "vertexCW" [HE.or(NUM)] => Varies, false;
    Source "source" [HE] => gives(&[VERT]), false;
    Target "target" [HE] => gives(&[VERT]), false;
    Face "face" [HE] => gives(&[FACE]), false;
    VertexPos "vertexpos" [PLACE] => gives(&[VEC3]), false;
    EdgeDirection "edgedirection" [HE] => gives(&[VEC3]), false;
    FaceNormal "facenormal" [SIDE] => gives(&[VEC3]), false;
    FaceMidpoint "facemidpoint" [SIDE] => gives(&[VEC3]), false;
    VertexNormal "vertexnormal" [PLACE] => gives(&[VEC3]), false;
    FaceDegree "facedegree" [SIDE] => gives(&[NUM]), false;
    Valence "valence" [PLACE] => gives(&[NUM]), false;
    IsBoundary "isboundary" [NODE] => gives(&[NUM]), false;
    SameEdge "sameEdge" [HE, HE] => gives(&[NUM]), false;
    SameFace "sameFace" [SIDE, SIDE] => gives(&[NUM]), false;
    SameVertex "sameVertex" [PLACE, PLACE] => gives(&[NUM]), false;
    Sharpness "sharpness" [PLACE] => gives(&[NUM]), false;
    IsSharp "issharp" [PLACE] => gives(&[NUM]), false;
    // Changes of the mesh
    MakeVefs "makeVEFS" [VEC3, VEC3] => gives(&[HE]), true;
    MakeEv "makeEV" [HE, HE, VEC3] => gives(&[HE]), true;
    MakeEvOne "makeEVone" [HE, VEC3] => gives(&[HE]), true;
    MakeEf "makeEF" [HE, HE] => gives(&[HE]), true;
    MakeFaces "makeFaces" [HE, ARR, ARR] => gives(&[ARR]), true;
    KillEf "killEF" [HE] => gives(&[]), true;
    KillEv "killEV" [HE] => gives(&[]), true;
    KillVefs "killVEFS" [HE] => gives(&[]), true;
    MoveV "moveV" [PLACE, VEC3] => gives(&[]), true;
    MoveE "moveE" [HE, VEC3] => gives(&[]), true;
    MoveF "moveF" [SIDE, VEC3] => gives(&[]), true;
    SharpE "sharpE" [HE, NUM] => gives(&[]), true;
    SharpF "sharpF" [SIDE, NUM] => gives(&[]), true;
    SharpV "sharpV" [PLACE, NUM] => gives(&[]), true;
    SetSharpness "setsharpness" [PLACE, NUM] => gives(&[]), true;
    // Attributes and links
    AttrGet "attrget" [NODE, KEY] => gives(&[ANY]), false;
    AttrHas "attrhas" [NODE, KEY] => gives(&[NUM]), false;
    AttrSet "attrset" [NODE, KEY, ANY] => gives(&[]), true;
    AttrDel "attrdel" [NODE, KEY] => gives(&[]), true;
    LinkSet "linkset" [NODE, KEY, NODE] => gives(&[]), true;
    LinkGet "linkget" [NODE, KEY] => gives(&[NODE]), false;
    LinkHas "linkhas" [NODE, KEY] => gives(&[NUM]), false;
    LinkDel "linkdel" [NODE, KEY, NODE] => gives(&[]), true;
}
