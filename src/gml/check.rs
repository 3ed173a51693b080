//! The check before a script ever runs: what it does to the stack, as far as that can be known.
//!
//! The script is followed with kinds instead of values. Where its way depends on values (a loop's `exit`, a word such
//! as `roll` with numbers that are not written down, a procedure from a dictionary) the check ends without a
//! verdict, and mistakes are found when the script runs.

use super::kind::Kinds;
use super::program::{Op, Program};
use super::source::Diagnostic;
use super::value::Value;
use super::word::{Gives, Word};

/// Procedures inside one another that are followed.
const DEEPEST: usize = 30;
/// Operations that are followed in one script.
const LONGEST: usize = 100_000;

/// What is known of a value on the stack.
#[derive(Clone, Copy, PartialEq, Debug)]
struct Known {
    kinds: Kinds,
    /// The value, if it is written in the script.
    value: Option<Value>,
}

/// What a script must leave on the stack.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Leaves {
    Nothing,
    OneNumber,
}

/// Why the check ended early.
enum End {
    /// No verdict: the rest depends on values.
    Unknown,
    Mistake(usize, String),
}

struct Checker<'a> {
    program: &'a Program,
    stack: Vec<Known>,
    registers: Vec<Option<Known>>,
    /// Procedures may be in arrays, dictionaries or registers, so that any value of unknown kind may be one.
    procedures_travel: bool,
    depth: usize,
    left: usize,
}

/// Follows `program` from an empty stack.
pub(crate) fn check(program: &Program, leaves: Leaves) -> Option<Diagnostic> {
    let mut checker = Checker {
        program,
        stack: Vec::new(),
        registers: vec![None; program.registers as usize],
        procedures_travel: procedures_travel(program),
        depth: 0,
        left: LONGEST,
    };
    let (op, message) = match checker.block(0) {
        Ok(()) => match (leaves, checker.stack.as_slice()) {
            (Leaves::Nothing, []) => return None,
            (Leaves::Nothing, left) => {
                let plural = if left.len() == 1 { "" } else { "s" };
                (
                    program.last_op(),
                    format!(
                        "the action leaves {} value{plural} on the stack; it must leave none",
                        left.len()
                    ),
                )
            }
            (Leaves::OneNumber, [one]) if one.kinds.meets(Kinds::NUMBER) => return None,
            (Leaves::OneNumber, [one]) => (
                program.last_op(),
                format!("the condition leaves {}; it must leave one number", one.kinds.describe()),
            ),
            (Leaves::OneNumber, left) => (
                program.last_op(),
                format!("the condition leaves {} values on the stack; it must leave one number", left.len()),
            ),
        },
        Err(End::Unknown) => return None,
        Err(End::Mistake(op, message)) => (op, message),
    };
    Some(program.error(op, message))
}

/// True unless every procedure is taken by a control word right after it.
fn procedures_travel(program: &Program) -> bool {
    let is_procedure = |op: Option<&Op>| matches!(op, Some(Op::Push(Value::Procedure(_))));
    program.ops.iter().enumerate().any(|(i, op)| {
        is_procedure(Some(op))
            && !match program.ops.get(i + 1) {
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
    fn push(&mut self, kinds: Kinds) {
        self.stack.push(Known { kinds, value: None });
    }

    fn block(&mut self, block: u32) -> Result<(), End> {
        if self.depth >= DEEPEST {
            return Err(End::Unknown);
        }
        self.depth += 1;
        let mut at = self.program.block(block);
        loop {
            self.left = self.left.checked_sub(1).ok_or(End::Unknown)?;
            match self.program.ops[at] {
                Op::Push(value) => {
                    self.stack.push(Known { kinds: Kinds::of_value(&value), value: Some(value) });
                }
                Op::Node { domain, .. } => self.push(Kinds::of_domain(domain)),
                Op::Parameter(_) => self.push(Kinds::NUMBER),
                Op::Load(slot) => {
                    let known = self.load(slot);
                    self.execute(known)?;
                }
                Op::LoadRaw(slot) => {
                    let known = self.load(slot);
                    self.stack.push(known);
                }
                Op::Store(slot) => {
                    let known = self.pop(at, "!")?;
                    self.registers[slot as usize] = Some(known);
                }
                Op::UseRegisters { .. } => {}
                Op::Word(word) => self.word(at, word)?,
                Op::Lookup(_) | Op::Member(_) => return Err(End::Unknown),
                Op::Return => {
                    self.depth -= 1;
                    return Ok(());
                }
            }
            at += 1;
        }
    }

    fn load(&self, slot: u32) -> Known {
        self.registers[slot as usize].unwrap_or(Known { kinds: Kinds::ANY, value: None })
    }

    /// Pushes a value, or follows it when it is a procedure.
    fn execute(&mut self, known: Known) -> Result<(), End> {
        match known.value {
            Some(Value::Procedure(block)) => self.block(block),
            _ if known.kinds.meets(Kinds::PROCEDURE) && self.procedures_travel => Err(End::Unknown),
            _ => {
                self.stack.push(known);
                Ok(())
            }
        }
    }

    fn pop(&mut self, at: usize, word: &str) -> Result<Known, End> {
        self.stack.pop().ok_or_else(|| {
            End::Mistake(at, format!("`{word}` needs more values than there are on the stack"))
        })
    }

    /// Takes what a word takes; the top value last.
    fn take(&mut self, at: usize, word: Word) -> Result<Vec<Known>, End> {
        let signature = word.signature();
        let mut taken = Vec::new();
        for wanted in signature.takes.iter().rev() {
            let known = self.pop(at, signature.name)?;
            if !known.kinds.meets(*wanted) {
                let message = format!(
                    "`{}` needs {}, not {}",
                    signature.name,
                    wanted.describe(),
                    known.kinds.describe()
                );
                return Err(End::Mistake(at, message));
            }
            taken.push(known);
        }
        taken.reverse();
        Ok(taken)
    }

    fn word(&mut self, at: usize, word: Word) -> Result<(), End> {
        let taken = self.take(at, word)?;
        if let Gives::Fixed(kinds) = word.signature().gives {
            self.fixed(at, word, &taken, kinds)?;
            return Ok(());
        }
        let procedure = |known: &Known| match known.value {
            Some(Value::Procedure(block)) => Ok(block),
            _ => Err(End::Unknown),
        };
        match (word, taken.as_slice()) {
            (Word::Dup, [a]) => self.stack.extend([*a, *a]),
            (Word::Exch, [a, b]) => self.stack.extend([*b, *a]),
            (Word::Index, [depth]) => {
                let depth = number(depth)?;
                let place = self.stack.len().checked_sub(depth + 1);
                let known = place.map(|place| self.stack[place]);
                self.stack.push(known.ok_or_else(|| shallow(at, word))?);
            }
            (Word::Roll, [count, turns]) => {
                let count = number(count)?;
                let Some(Value::Number(turns)) = turns.value else { return Err(End::Unknown) };
                let start = self.stack.len().checked_sub(count).ok_or_else(|| shallow(at, word))?;
                if count > 0 {
                    self.stack[start..].rotate_right((turns as i64).rem_euclid(count as i64) as usize);
                }
            }
            (Word::Clear, _) => self.stack.clear(),
            (Word::ClearToMark, _) => {
                let mark = self.mark(at)?;
                self.stack.truncate(mark);
            }
            (Word::CloseArray, _) => {
                let mark = self.mark(at)?;
                self.stack.truncate(mark);
                self.push(Kinds::ARRAY);
            }
            (Word::FaceCcw | Word::FaceCw | Word::VertexCcw | Word::VertexCw, [top]) => {
                if top.kinds == Kinds::NUMBER {
                    let below = self.pop(at, word.signature().name)?;
                    if !below.kinds.meets(Kinds::HALF_EDGE) {
                        let (name, found) = (word.signature().name, below.kinds.describe());
                        return Err(End::Mistake(at, format!("`{name}` needs a half-edge, not {found}")));
                    }
                } else if top.kinds.meets(Kinds::NUMBER) {
                    return Err(End::Unknown);
                }
                self.push(Kinds::HALF_EDGE);
            }
            (Word::Exec, [known]) => {
                if !known.kinds.meets(Kinds::PROCEDURE) {
                    self.stack.push(*known);
                } else {
                    self.block(procedure(known)?)?;
                }
            }
            (Word::If, [_, body]) => self.branch(procedure(body)?)?,
            (Word::IfElse, [_, yes, no]) => self.branches(procedure(yes)?, procedure(no)?)?,
            (Word::Repeat, [_, body]) => self.turns(procedure(body)?, &[])?,
            (Word::For | Word::ForX, [_, _, _, body]) => self.turns(procedure(body)?, &[Kinds::NUMBER])?,
            (Word::ForAll, [_, body]) => self.turns(procedure(body)?, &[Kinds::ANY])?,
            (Word::Map, [_, body]) => self.collect(procedure(body)?, 1)?,
            (Word::TwoMap, [_, _, body]) => self.collect(procedure(body)?, 2)?,
            (Word::TwoForAll, [_, _, body]) => self.turns(procedure(body)?, &[Kinds::ANY; 2])?,
            _ => return Err(End::Unknown),
        }
        Ok(())
    }

    /// A word with a fixed effect. Some give a narrower kind than their signature says.
    fn fixed(&mut self, at: usize, word: Word, taken: &[Known], kinds: &[Kinds]) -> Result<(), End> {
        match (word, taken) {
            (Word::CountToMark, _) => {
                self.mark(at)?;
                self.push(Kinds::NUMBER);
            }
            (Word::Add | Word::Sub, [a, b]) => {
                let known = a.kinds.within(Kinds::LINEAR) && b.kinds.within(Kinds::LINEAR);
                if known && !a.kinds.meets(b.kinds) {
                    let name = word.signature().name;
                    let [a, b] = [a, b].map(|known| known.kinds.describe());
                    return Err(End::Mistake(at, format!("`{name}` cannot take {a} and {b}")));
                }
                let both = if known { a.kinds } else { Kinds::LINEAR };
                self.push(both);
            }
            (Word::Neg | Word::Div, [a, ..]) | (Word::Lerp, [a, ..]) if a.kinds.within(Kinds::LINEAR) => {
                self.push(a.kinds);
            }
            (Word::Mul, [a, b]) if a.kinds == Kinds::NUMBER && b.kinds == Kinds::NUMBER => {
                self.push(Kinds::NUMBER);
            }
            _ => kinds.iter().for_each(|kinds| self.push(*kinds)),
        }
        Ok(())
    }

    /// Place of the topmost mark.
    fn mark(&self, at: usize) -> Result<usize, End> {
        let mark = self.stack.iter().rposition(|known| known.kinds.meets(Kinds::MARK));
        match mark {
            None => Err(End::Mistake(at, "there is no mark on the stack".to_owned())),
            // A value of unknown kind could be the mark.
            Some(place) if self.stack[place].kinds != Kinds::MARK => {
                let exact = self.stack.iter().rposition(|known| known.kinds == Kinds::MARK);
                exact.ok_or(End::Unknown)
            }
            Some(place) => Ok(place),
        }
    }

    /// A copy of what is known.
    fn state(&mut self) -> Result<(Vec<Known>, Vec<Option<Known>>), End> {
        let size = self.stack.len() + self.registers.len();
        self.left = self.left.checked_sub(size).ok_or(End::Unknown)?;
        Ok((self.stack.clone(), self.registers.clone()))
    }

    /// A procedure that may or may not run.
    fn branch(&mut self, block: u32) -> Result<(), End> {
        let before = self.state()?;
        self.block(block)?;
        self.merge(before)
    }

    fn branches(&mut self, yes: u32, no: u32) -> Result<(), End> {
        let before = self.state()?;
        self.block(yes)?;
        let after_yes = std::mem::replace(&mut self.stack, before.0);
        let registers = std::mem::replace(&mut self.registers, before.1);
        self.block(no)?;
        self.merge((after_yes, registers))
    }

    /// The turns of a loop: only the first is followed.
    fn turns(&mut self, block: u32, elements: &[Kinds]) -> Result<(), End> {
        let before = self.state()?;
        elements.iter().for_each(|kinds| self.push(*kinds));
        self.block(block)?;
        self.merge(before)
    }

    /// The turns of a map over `arrays` arrays.
    fn collect(&mut self, block: u32, arrays: usize) -> Result<(), End> {
        let before = self.state()?;
        (0..arrays).for_each(|_| self.push(Kinds::ANY));
        self.block(block)?;
        self.stack.pop().ok_or(End::Unknown)?;
        self.merge(before)?;
        self.push(Kinds::ARRAY);
        Ok(())
    }

    /// What is known when the script came here in one of two ways.
    fn merge(&mut self, (stack, registers): (Vec<Known>, Vec<Option<Known>>)) -> Result<(), End> {
        if stack.len() != self.stack.len() {
            return Err(End::Unknown);
        }
        let join = |a: &Known, b: &Known| {
            if a == b { *a } else { Known { kinds: a.kinds.or(b.kinds), value: None } }
        };
        self.stack = self.stack.iter().zip(&stack).map(|(a, b)| join(a, b)).collect();
        self.registers = self
            .registers
            .iter()
            .zip(&registers)
            .map(|(a, b)| Some(join(a.as_ref()?, b.as_ref()?)))
            .collect();
        Ok(())
    }
}

fn number(known: &Known) -> Result<usize, End> {
    match known.value {
        Some(Value::Number(x)) if x >= 0.0 && x.fract() == 0.0 && x < 1e6 => Ok(x as usize),
        _ => Err(End::Unknown),
    }
}

fn shallow(at: usize, word: Word) -> End {
    End::Mistake(at, format!("`{}` reaches below the bottom of the stack", word.signature().name))
}
