//! The check before a script ever runs: what it does to the stack, as far as that can be known, and what it does to
//! attributes and links.
//!
//! The script is followed with kinds instead of values (abstract interpretation): loops until nothing new is learnt,
//! branches both ways, `exit` and `throw` to where they lead. Where the way depends on values - a procedure from an
//! array, a name that is defined twice - nothing is known afterwards, and mistakes there are found when the script
//! runs. Every mistake that is reported is certain once its place is reached.

mod control;
mod state;
mod words;

use super::kind::Kinds;
use super::program::{Op, Program, StringId};
use super::source::Diagnostic;
use super::value::Value;
use super::word::Word;
use rustc_hash::FxHashMap;
use state::{Known, State};

/// Procedures inside one another that are followed.
const DEEPEST: usize = 30;
/// Operations that are followed in one script.
const LONGEST: usize = 100_000;
/// Turns of a loop after which nothing is taken for known.
const MOST_TURNS: usize = 8;

/// What a script must leave on the stack.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Leaves {
    Nothing,
    OneNumber,
}

/// Something that a script does to attributes and links.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct Effect {
    /// `AttrSet`, `AttrDel`, `LinkSet` or `LinkDel`.
    pub(crate) word: Word,
    /// The node of the pattern to which it does it, if that is certain.
    pub(crate) node: Option<u32>,
    /// The name or the label.
    pub(crate) key: StringId,
    /// The value that is set, if it is written in the script.
    pub(crate) value: Option<Value>,
}

/// What a script does to the mesh, wherever it does it.
#[derive(Clone, Default, Debug)]
pub(crate) struct Effects {
    pub(crate) annotations: Vec<Effect>,
    /// It may make or remove elements.
    pub(crate) topology: bool,
    /// It may move vertices or set sharpness.
    pub(crate) moves: bool,
    /// It may set attributes and links that are not in the list.
    pub(crate) sets_more: bool,
    /// It may delete attributes and links that are not in the list.
    pub(crate) deletes_more: bool,
}

/// What the check found.
#[derive(Default)]
pub(crate) struct Checked {
    pub(crate) mistake: Option<Diagnostic>,
    pub(crate) warnings: Vec<Diagnostic>,
    pub(crate) effects: Effects,
}

/// Why the check ended early.
enum End {
    /// The script is too long or too deep to be followed.
    Unknown,
    Mistake(usize, String),
}

struct Checker<'a> {
    program: &'a Program,
    state: State,
    /// The operation at hand can be reached.
    live: bool,
    /// For each open loop what is known where `exit` leaves it.
    exits: Vec<Option<State>>,
    /// Values of names in dictionaries; `None` for anything.
    defined: FxHashMap<StringId, Known>,
    /// How often something new was learnt about names.
    learnt: usize,
    /// `put` may have defined any name.
    wild: bool,
    /// Procedures may be in arrays and dictionaries, so that any value of unknown kind may be one.
    procedures_travel: bool,
    /// Arrays are changed after they were made.
    arrays_change: bool,
    throws: usize,
    visited: Vec<bool>,
    effects: Effects,
    warnings: Vec<(usize, String)>,
    depth: usize,
    left: usize,
}

/// Follows `program` from an empty stack.
pub(crate) fn check(program: &Program, leaves: Leaves) -> Checked {
    let mut checker = Checker {
        program,
        state: State::new(program.registers as usize),
        live: true,
        exits: Vec::new(),
        defined: FxHashMap::default(),
        learnt: 0,
        wild: false,
        procedures_travel: procedures_travel(program),
        arrays_change: uses(program, &[Word::Put, Word::Append]),
        throws: 0,
        visited: vec![false; program.blocks.len()],
        effects: Effects::default(),
        warnings: Vec::new(),
        depth: 0,
        left: LONGEST,
    };
    let mistake = match checker.block(0) {
        Ok(()) => checker.end(leaves).map(|message| program.error(program.last_op(), message)),
        Err(End::Unknown) => {
            checker.effects = Effects {
                sets_more: true,
                deletes_more: true,
                topology: true,
                moves: true,
                ..checker.effects
            };
            None
        }
        Err(End::Mistake(op, message)) => Some(program.error(op, message)),
    };
    checker.look_at_the_rest();
    let mut warnings: Vec<Diagnostic> = checker
        .warnings
        .iter()
        .map(|(op, message)| program.error(*op, message.as_str()).into_warning())
        .collect();
    warnings.sort_by_key(Diagnostic::offset);
    warnings.dedup();
    Checked { mistake, warnings, effects: checker.effects }
}

fn uses(program: &Program, words: &[Word]) -> bool {
    program.ops.iter().any(|op| matches!(op, Op::Word(word) if words.contains(word)))
}

/// True unless every procedure is taken by a control word, a register or a definition right after it, so that no
/// value of unknown kind can be one.
fn procedures_travel(program: &Program) -> bool {
    let gets = uses(program, &[Word::Get]);
    let is_procedure = |op: Option<&Op>| matches!(op, Some(Op::Push(Value::Procedure(_))));
    program.ops.iter().enumerate().any(|(i, op)| {
        is_procedure(Some(op))
            && !match program.ops.get(i + 1) {
                Some(Op::Store(_)) => true,
                Some(Op::Word(Word::Def)) => !gets,
                Some(Op::Word(word)) => takes_procedure(*word),
                next => {
                    is_procedure(next)
                        && matches!(program.ops.get(i + 2), Some(Op::Word(Word::IfElse | Word::Catch)))
                }
            }
    })
}

fn takes_procedure(word: Word) -> bool {
    word.signature().takes.last().is_some_and(|kinds| *kinds == Kinds::PROCEDURE) || word == Word::Exec
}

impl Checker<'_> {
    /// What is wrong with what is left at the end.
    fn end(&self, leaves: Leaves) -> Option<String> {
        if !self.live {
            return None;
        }
        let State { stack, open, .. } = &self.state;
        let at_least = if *open { "at least " } else { "" };
        let plural = if stack.len() == 1 { "" } else { "s" };
        match (leaves, stack.as_slice()) {
            (Leaves::Nothing, []) => None,
            (Leaves::Nothing, left) => Some(format!(
                "the action leaves {at_least}{} value{plural} on the stack; it must leave none",
                left.len()
            )),
            (Leaves::OneNumber, [one]) if one.kinds.meets(Kinds::NUMBER) => None,
            (Leaves::OneNumber, [one]) => {
                Some(format!("the condition leaves {}; it must leave one number", one.kinds.describe()))
            }
            (Leaves::OneNumber, []) if *open => None,
            (Leaves::OneNumber, left) => Some(format!(
                "the condition leaves {at_least}{} values on the stack; it must leave one number",
                left.len()
            )),
        }
    }

    /// Procedures that were not followed may still run.
    fn look_at_the_rest(&mut self) {
        let starts = &self.program.blocks;
        for (block, _) in self.visited.iter().enumerate().filter(|(_, visited)| !**visited) {
            let end = starts.get(block + 1).map_or(self.program.ops.len(), |&next| next as usize);
            for op in &self.program.ops[self.program.block(block as u32)..end] {
                let Op::Word(word) = op else { continue };
                match word {
                    Word::AttrSet | Word::LinkSet => self.effects.sets_more = true,
                    Word::AttrDel | Word::LinkDel => self.effects.deletes_more = true,
                    Word::MoveV | Word::MoveE | Word::MoveF => self.effects.moves = true,
                    Word::SharpE | Word::SharpF | Word::SharpV | Word::SetSharpness => {
                        self.effects.moves = true
                    }
                    word => self.effects.topology |= word.signature().edits,
                }
            }
        }
    }

    fn push(&mut self, kinds: Kinds) {
        self.state.stack.push(Known::of(kinds));
    }

    /// Follows a block from what is known now.
    fn block(&mut self, block: u32) -> Result<(), End> {
        if self.depth >= DEEPEST {
            return Err(End::Unknown);
        }
        self.depth += 1;
        if let Some(visited) = self.visited.get_mut(block as usize) {
            *visited = true;
        }
        let mut at = self.program.block(block);
        while self.live {
            self.left = self.left.checked_sub(1).ok_or(End::Unknown)?;
            match self.program.ops[at] {
                Op::Push(value) => {
                    self.state.stack.push(Known { value: Some(value), ..Known::of(Kinds::of_value(&value)) });
                }
                Op::Node { index, domain } => {
                    self.state.stack.push(Known { node: Some(index), ..Known::of(Kinds::of_domain(domain)) });
                }
                Op::Parameter(_) => self.push(Kinds::NUMBER),
                Op::Load(slot) => {
                    let known = self.load(slot);
                    self.execute(known)?;
                }
                Op::LoadRaw(slot) => {
                    let known = self.load(slot);
                    self.state.stack.push(known);
                }
                Op::Store(slot) => {
                    let known = self.pop(at, "!")?;
                    self.state.registers[slot as usize] = Some(known);
                }
                Op::UseRegisters { .. } => {}
                Op::Word(word) => self.word(at, word)?,
                Op::Lookup(name) => {
                    let known = self.lookup(name);
                    self.execute(known)?;
                }
                Op::Member(name) => {
                    let dict = self.pop(at, ".")?;
                    if !dict.kinds.meets(Kinds::DICT) {
                        let message = format!("`.` needs a dictionary, not {}", dict.kinds.describe());
                        return Err(End::Mistake(at, message));
                    }
                    let known = self.lookup(name);
                    self.execute(known)?;
                }
                Op::Return => break,
            }
            at += 1;
        }
        self.depth -= 1;
        Ok(())
    }

    fn load(&self, slot: u32) -> Known {
        self.state.registers[slot as usize].unwrap_or(Known::ANY)
    }

    fn lookup(&self, name: StringId) -> Known {
        if self.wild { Known::ANY } else { self.defined.get(&name).copied().unwrap_or(Known::ANY) }
    }

    /// A name gets a value in some dictionary.
    fn define(&mut self, name: StringId, known: Known) {
        let before = self.defined.get(&name).copied();
        let after = before.map_or(known, |before| before.join(known));
        self.learnt += usize::from(before != Some(after));
        self.defined.insert(name, after);
    }

    /// Pushes a value, or follows it when it is a procedure.
    fn execute(&mut self, known: Known) -> Result<(), End> {
        match known.value {
            Some(Value::Procedure(block)) => return self.block(block),
            _ if self.may_be_procedure(known) => self.anything(),
            _ => self.state.stack.push(known),
        }
        Ok(())
    }

    fn may_be_procedure(&self, known: Known) -> bool {
        known.kinds.meets(Kinds::PROCEDURE) && (self.procedures_travel || known.kinds != Kinds::ANY)
    }

    /// A procedure runs that is not known.
    fn anything(&mut self) {
        self.state.forget();
        if let Some(exit) = self.exits.last_mut() {
            *exit = Some(self.state.clone());
        }
        self.throws += 1;
    }

    fn pop(&mut self, at: usize, word: &str) -> Result<Known, End> {
        match self.state.stack.pop() {
            Some(known) => Ok(known),
            None if self.state.open => Ok(Known::ANY),
            None => Err(End::Mistake(at, format!("`{word}` needs more values than there are on the stack"))),
        }
    }

    /// Takes what a word takes; the top value last.
    fn take(&mut self, at: usize, word: Word) -> Result<Vec<Known>, End> {
        let signature = word.signature();
        let mut taken = Vec::new();
        for wanted in signature.takes.iter().rev() {
            let known = self.pop(at, signature.name)?;
            self.require(at, word, *wanted, known)?;
            taken.push(known);
        }
        taken.reverse();
        Ok(taken)
    }

    fn require(&self, at: usize, word: Word, wanted: Kinds, found: Known) -> Result<(), End> {
        if found.kinds.meets(wanted) {
            return Ok(());
        }
        let (name, found) = (word.signature().name, found.kinds.describe());
        Err(End::Mistake(at, format!("`{name}` needs {}, not {found}", wanted.describe())))
    }
}
