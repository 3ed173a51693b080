//! Tokens to programs: names are resolved to words, nodes, parameters and registers.

use super::lex::{self, Cursor, Token};
use super::program::{Op, Program, Strings};
use super::source::{Diagnostic, MOST_MISTAKES, Source, Span};
use super::value::Value;
use super::word::Word;
use crate::mesh::Domain;
use rustc_hash::{FxHashMap, FxHashSet};
use std::sync::Arc;

/// Names that a script can use besides the words of the language.
#[derive(Clone, Default, Debug)]
pub struct Scope<'a> {
    /// Nodes of the pattern, in their order.
    pub nodes: &'a [(String, Domain)],
    /// Parameters, in their order.
    pub parameters: &'a [String],
    /// True for a condition, which may not change the mesh.
    pub read_only: bool,
}

/// A named piece of script that the scripts below it use as a word: `define name { ... }` of a rule file.
#[derive(Clone, Debug)]
pub(crate) struct Definition {
    pub(crate) name: String,
    pub(crate) tokens: Vec<(Token, Span)>,
}

/// Compiles a whole text as one script.
///
/// # Errors
/// All mistakes that were found, in the order of the text.
pub fn compile(
    source: &Arc<Source>,
    scope: &Scope<'_>,
    strings: &mut Strings,
) -> Result<Program, Vec<Diagnostic>> {
    let mut errors = Vec::new();
    let mut cursor = Cursor::new(source);
    let tokens = lex::script(&mut cursor, None, &mut errors);
    let end = Span { start: cursor.offset(), end: cursor.offset() };
    let program = compile_tokens(source, &tokens, end, scope, &[], strings, &mut errors);
    errors.sort_by_key(Diagnostic::offset);
    if errors.is_empty() { Ok(program) } else { Err(errors) }
}

/// Compiles the tokens of a script that ends at `end`; it can use `definitions`, and each of these the ones before it.
/// Mistakes are added to `errors`.
pub(crate) fn compile_tokens(
    source: &Arc<Source>,
    tokens: &[(Token, Span)],
    end: Span,
    scope: &Scope<'_>,
    definitions: &[Definition],
    strings: &mut Strings,
    errors: &mut Vec<Diagnostic>,
) -> Program {
    let defined = tokens
        .iter()
        .filter_map(|(token, _)| if let Token::Literal(name) = token { Some(name.as_str()) } else { None })
        .collect();
    let mut compiler = Compiler {
        source,
        scope,
        definitions,
        known_definitions: definitions.len(),
        blocks_of_definitions: FxHashMap::default(),
        strings,
        errors,
        defined,
        open: vec![OpenBlock { number: 0, ops: Vec::new(), spans: Vec::new(), start: end, registers: None }],
        brackets: Vec::new(),
        finished: Vec::new(),
        block_count: 1,
        register_sets: Vec::new(),
        slots: Vec::new(),
    };
    for (token, span) in tokens {
        compiler.token(token, *span);
    }
    compiler.finish(end)
}

/// True when `name` is a word of the language, so that nothing else can be called so.
pub(crate) fn is_word(name: &str) -> bool {
    name == "usereg" || Word::named(name).is_some()
}

struct OpenBlock {
    number: u32,
    ops: Vec<Op>,
    spans: Vec<Span>,
    start: Span,
    /// The set of registers in use here.
    registers: Option<usize>,
}

/// The registers that one `usereg` begins.
#[derive(Default)]
struct RegisterSet {
    slots: FxHashMap<String, u32>,
    /// The block whose `usereg` it is.
    block: u32,
}

struct Slot {
    name: String,
    set: usize,
    stored: bool,
    /// The first use before any store.
    early: Option<Span>,
    /// That use stands in the block of `usereg` itself, which runs from top to bottom.
    early_is_certain: bool,
}

struct Compiler<'a> {
    source: &'a Arc<Source>,
    scope: &'a Scope<'a>,
    definitions: &'a [Definition],
    /// How many of them can be used at this place.
    known_definitions: usize,
    /// The block of each definition that was used.
    blocks_of_definitions: FxHashMap<usize, u32>,
    strings: &'a mut Strings,
    errors: &'a mut Vec<Diagnostic>,
    /// Names that `/name` mentions: they may be in a dictionary when the script runs.
    defined: FxHashSet<&'a str>,
    open: Vec<OpenBlock>,
    /// Open `[` and the depth of blocks they stand in.
    brackets: Vec<(Span, usize)>,
    finished: Vec<(u32, Vec<Op>, Vec<Span>)>,
    block_count: u32,
    register_sets: Vec<RegisterSet>,
    slots: Vec<Slot>,
}

impl Compiler<'_> {
    fn error(&mut self, span: Span, message: impl Into<String>) {
        if self.errors.len() >= MOST_MISTAKES {
            return;
        }
        self.errors.push(Diagnostic::new(self.source, span, message));
    }

    fn emit(&mut self, op: Op, span: Span) {
        if let Some(block) = self.open.last_mut() {
            block.ops.push(op);
            block.spans.push(span);
        }
    }

    fn token(&mut self, token: &Token, span: Span) {
        match token {
            Token::Number(x) => self.emit(Op::Push(Value::Number(*x)), span),
            Token::Text(text) => {
                let id = self.strings.intern(text);
                self.emit(Op::Push(Value::Text(id)), span);
            }
            Token::Vec2(v) => self.emit(Op::Push(Value::Vec2(*v)), span),
            Token::Vec3(v) => self.emit(Op::Push(Value::Vec3(*v)), span),
            Token::Literal(name) => {
                let id = self.strings.intern(name);
                self.emit(Op::Push(Value::Name(id)), span);
            }
            Token::Member(name) => {
                let id = self.strings.intern(name);
                self.emit(Op::Member(id), span);
            }
            Token::Name(name) => self.name(name, span),
            Token::Store(name) => {
                if let Some(slot) = self.register(name, span) {
                    self.slots[slot as usize].stored = true;
                    self.emit(Op::Store(slot), span);
                }
            }
            Token::Load(name) => {
                if let Some(slot) = self.load(name, span) {
                    self.emit(Op::Load(slot), span);
                }
            }
            Token::LoadRaw(name) => {
                if let Some(slot) = self.load(name, span) {
                    self.emit(Op::LoadRaw(slot), span);
                }
            }
            Token::OpenArray => {
                self.brackets.push((span, self.open.len()));
                self.emit(Op::Word(Word::OpenArray), span);
            }
            Token::CloseArray => match self.brackets.last() {
                Some(&(_, depth)) if depth == self.open.len() => {
                    self.brackets.pop();
                    self.emit(Op::Word(Word::CloseArray), span);
                }
                _ => self.error(span, "`]` without its `[`"),
            },
            Token::OpenBlock => {
                let registers = self.open.last().and_then(|block| block.registers);
                let number = self.block_count;
                self.block_count += 1;
                self.open.push(OpenBlock {
                    number,
                    ops: Vec::new(),
                    spans: Vec::new(),
                    start: span,
                    registers,
                });
            }
            Token::CloseBlock => self.close_block(span),
        }
    }

    fn close_block(&mut self, span: Span) {
        while let Some(&(bracket, depth)) = self.brackets.last() {
            if depth < self.open.len() {
                break;
            }
            self.brackets.pop();
            self.error(bracket, "`[` without its `]` in the same procedure");
        }
        if self.open.len() < 2 {
            self.error(span, "`}` without its `{`");
            return;
        }
        if let Some(number) = self.end_block(span) {
            self.emit(Op::Push(Value::Procedure(number)), span);
        }
    }

    fn end_block(&mut self, end: Span) -> Option<u32> {
        let mut block = self.open.pop()?;
        block.ops.push(Op::Return);
        block.spans.push(end);
        self.finished.push((block.number, block.ops, block.spans));
        Some(block.number)
    }

    fn name(&mut self, name: &str, span: Span) {
        if name == "usereg" {
            return self.use_registers(span);
        }
        let nodes = self.scope.nodes;
        if let Some(index) = nodes.iter().position(|node| node.0 == name) {
            return self.emit(Op::Node { index: index as u32, domain: nodes[index].1 }, span);
        }
        if let Some(index) = self.scope.parameters.iter().position(|known| known == name) {
            return self.emit(Op::Parameter(index as u32), span);
        }
        if let Some(word) = Word::named(name) {
            if word.signature().edits && self.scope.read_only {
                self.error(span, format!("`{name}` changes the mesh; a condition may only look at it"));
            }
            return self.emit(Op::Word(word), span);
        }
        let definitions = self.definitions;
        if let Some(index) = definitions[..self.known_definitions].iter().position(|known| known.name == name)
        {
            let block = self.definition(index, span);
            self.emit(Op::Push(Value::Procedure(block)), span);
            return self.emit(Op::Word(Word::Exec), span);
        }
        if self.defined.contains(name) {
            let id = self.strings.intern(name);
            return self.emit(Op::Lookup(id), span);
        }
        if self.errors.len() >= MOST_MISTAKES {
            return;
        }
        let hint = self.nearest(name).map_or_else(String::new, |near| format!("; did you mean `{near}`?"));
        self.error(span, format!("unknown word `{name}`{hint}"));
    }

    /// The block of a definition, compiled at its first use; its operations stand at that place of the text. It sees
    /// no nodes, no registers of the script around it, and only the definitions above it.
    fn definition(&mut self, index: usize, span: Span) -> u32 {
        if let Some(&block) = self.blocks_of_definitions.get(&index) {
            return block;
        }
        let number = self.block_count;
        self.block_count += 1;
        self.blocks_of_definitions.insert(index, number);
        let outer_definitions = std::mem::replace(&mut self.known_definitions, index);
        self.open.push(OpenBlock {
            number,
            ops: Vec::new(),
            spans: Vec::new(),
            start: span,
            registers: None,
        });
        let definitions = self.definitions;
        for (token, _) in &definitions[index].tokens {
            self.token(token, span);
        }
        self.end_block(span);
        self.known_definitions = outer_definitions;
        number
    }

    /// The known name that is most like `name`, if any is alike.
    fn nearest(&self, name: &str) -> Option<String> {
        let known = (Word::ALL.iter().map(|word| word.signature().name))
            .chain(["usereg"])
            .chain(self.scope.nodes.iter().map(|node| node.0.as_str()))
            .chain(self.scope.parameters.iter().map(String::as_str))
            .chain(self.definitions.iter().map(|known| known.name.as_str()));
        nearest(name, known)
    }

    fn use_registers(&mut self, span: Span) {
        let Some(block) = self.open.last() else { return };
        if let Some(set) = block.registers
            && self.register_sets[set].block == block.number
        {
            return self.error(span, "`usereg` stands twice in one procedure");
        }
        let set = self.register_sets.len();
        self.register_sets.push(RegisterSet { slots: FxHashMap::default(), block: block.number });
        self.emit(Op::UseRegisters { first: set as u32, count: 0 }, span);
        if let Some(block) = self.open.last_mut() {
            block.registers = Some(set);
        }
    }

    fn register(&mut self, name: &str, span: Span) -> Option<u32> {
        let Some(set) = self.open.last().and_then(|block| block.registers) else {
            self.error(span, format!("register `{name}` needs `usereg` at the beginning of the script"));
            return None;
        };
        let next = self.slots.len() as u32;
        let slot = *self.register_sets[set].slots.entry(name.to_owned()).or_insert(next);
        if slot == next {
            self.slots.push(Slot {
                name: name.to_owned(),
                set,
                stored: false,
                early: None,
                early_is_certain: false,
            });
        }
        Some(slot)
    }

    fn load(&mut self, name: &str, span: Span) -> Option<u32> {
        let slot = self.register(name, span)?;
        let certain = self.open.last().is_some_and(|block| {
            block.registers.is_some_and(|set| self.register_sets[set].block == block.number)
        });
        let entry = &mut self.slots[slot as usize];
        if !entry.stored {
            entry.early.get_or_insert(span);
            entry.early_is_certain |= certain;
        }
        Some(slot)
    }

    fn finish(mut self, end: Span) -> Program {
        while self.open.len() > 1 {
            let start = self.open.last().map_or(end, |block| block.start);
            self.error(start, "`{` without its `}`");
            self.end_block(end);
        }
        while let Some((bracket, _)) = self.brackets.pop() {
            self.error(bracket, "`[` without its `]` in the same procedure");
        }
        self.end_block(end);
        // The registers of one set stand together, so that `usereg` can put a range aside.
        let mut counts = vec![0u32; self.register_sets.len()];
        let places: Vec<u32> = self
            .slots
            .iter()
            .map(|slot| {
                counts[slot.set] += 1;
                counts[slot.set] - 1
            })
            .collect();
        let mut first = 0;
        let firsts: Vec<u32> = counts
            .iter()
            .map(|count| {
                first += count;
                first - count
            })
            .collect();
        let number = |slot: u32| firsts[self.slots[slot as usize].set] + places[slot as usize];
        self.finished.sort_unstable_by_key(|block| block.0);
        let mut program = Program {
            source: Arc::clone(self.source),
            ops: Vec::new(),
            spans: Vec::new(),
            blocks: Vec::new(),
            registers: first,
        };
        for (_, ops, spans) in &self.finished {
            program.blocks.push(program.ops.len() as u32);
            program.spans.extend(spans);
            program.ops.extend(ops.iter().map(|op| match *op {
                Op::Load(slot) => Op::Load(number(slot)),
                Op::LoadRaw(slot) => Op::LoadRaw(number(slot)),
                Op::Store(slot) => Op::Store(number(slot)),
                Op::UseRegisters { first: set, .. } => {
                    Op::UseRegisters { first: firsts[set as usize], count: counts[set as usize] }
                }
                op => op,
            }));
        }
        for slot in std::mem::take(&mut self.slots) {
            if let Some(span) = slot.early.filter(|_| !slot.stored || slot.early_is_certain) {
                self.error(span, format!("register `{}` is used before anything is stored in it", slot.name));
            }
        }
        program
    }
}

/// The name of `known` that is most like `name`: at most a third of its letters, or one, differ.
fn nearest<'a>(name: &str, known: impl Iterator<Item = &'a str>) -> Option<String> {
    let letters: Vec<char> = name.chars().take(40).flat_map(char::to_lowercase).collect();
    let (distance, best) = known
        .map(|candidate| {
            let other: Vec<char> = candidate.chars().flat_map(char::to_lowercase).collect();
            (edit_distance(&letters, &other), candidate)
        })
        .min_by_key(|(distance, _)| *distance)?;
    (letters.len() > 1 && distance <= (letters.len() / 3).max(1)).then(|| best.to_owned())
}

/// Letters to insert, remove or replace.
fn edit_distance(a: &[char], b: &[char]) -> usize {
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, x) in a.iter().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, y) in b.iter().enumerate() {
            let replaced = diagonal + usize::from(x != y);
            diagonal = row[j + 1];
            row[j + 1] = replaced.min(row[j] + 1).min(diagonal + 1);
        }
    }
    row[b.len()]
}
