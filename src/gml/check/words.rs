//! What each word does, in the check.

use super::state::Known;
use super::{Checker, Effect, End};
use crate::gml::kind::Kinds;
use crate::gml::value::Value;
use crate::gml::word::{Gives, Word};

impl Checker<'_> {
    pub(super) fn word(&mut self, at: usize, word: Word) -> Result<(), End> {
        let taken = self.take(at, word)?;
        self.note_effect(word, &taken);
        if let Gives::Fixed(kinds) = word.signature().gives {
            return self.fixed(at, word, &taken, kinds);
        }
        match (word, taken.as_slice()) {
            (Word::Dup, [a]) => self.state.stack.extend([*a, *a]),
            (Word::Exch, [a, b]) => self.state.stack.extend([*b, *a]),
            (Word::Index, [depth]) => {
                let known = match number(depth) {
                    None => Known::ANY,
                    Some(depth) => match self.state.stack.len().checked_sub(depth + 1) {
                        Some(place) => self.state.stack[place],
                        None if self.state.open => Known::ANY,
                        None => return Err(shallow(at, word)),
                    },
                };
                self.state.stack.push(known);
            }
            (Word::Roll, [count, turns]) => self.roll(at, count, turns)?,
            (Word::Clear, _) => {
                self.state.stack.clear();
                self.state.open = false;
            }
            (Word::ClearToMark, _) => {
                self.clear_to_mark(at)?;
            }
            (Word::CloseArray, _) => {
                let elements = self.clear_to_mark(at)?;
                let elements = if self.arrays_change { Kinds::ANY } else { elements };
                self.state.stack.push(Known { elements, ..Known::of(Kinds::ARRAY) });
            }
            (Word::Aload, _) => self.state.forget_stack(),
            (Word::Where, _) => {
                self.state.forget_stack();
                self.push(Kinds::NUMBER);
            }
            (Word::FaceCcw | Word::FaceCw | Word::VertexCcw | Word::VertexCw, [top]) => {
                if top.kinds == Kinds::NUMBER {
                    let below = self.pop(at, word.signature().name)?;
                    self.require(at, word, Kinds::HALF_EDGE, below)?;
                } else if top.kinds.meets(Kinds::NUMBER) {
                    // With a number or without: one value less may be left.
                    self.state.forget_stack();
                }
                self.push(Kinds::HALF_EDGE);
            }
            (Word::Exec, [known]) => self.execute(*known)?,
            (Word::Eval, [_, body]) => self.call(*body)?,
            (Word::If, [_, body]) => self.branch(*body)?,
            (Word::IfElse, [_, yes, no]) => self.branches(*yes, *no)?,
            (Word::Repeat, [_, body]) => self.turns(at, *body, &[], true)?,
            (Word::For | Word::ForX, [_, _, _, body]) => self.turns(at, *body, &[Kinds::NUMBER], true)?,
            (Word::Loop, [body]) => self.turns(at, *body, &[], false)?,
            (Word::ForAll, [a, body]) => self.turns(at, *body, &[a.elements], true)?,
            (Word::TwoForAll, [a, b, body]) => self.turns(at, *body, &[a.elements, b.elements], true)?,
            (Word::Map, [a, body]) => self.collect(at, *body, &[a.elements])?,
            (Word::TwoMap, [a, b, body]) => self.collect(at, *body, &[a.elements, b.elements])?,
            (Word::Exit, _) => self.exit(at)?,
            (Word::Catch, [body, handler]) => self.catch(*body, *handler)?,
            (Word::Throw, _) => {
                self.throws += 1;
                self.live = false;
            }
            _ => self.state.forget(),
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
            (Word::Def, [name, value]) | (Word::Edef, [value, name]) => match name.value {
                Some(Value::Name(id)) => self.define(id, *value),
                _ => self.wild = true,
            },
            (Word::Put, [container, key, value]) if container.kinds.meets(Kinds::DICT) => match key.value {
                Some(Value::Name(id) | Value::Text(id)) => self.define(id, *value),
                _ if key.kinds.meets(Kinds::KEY) => self.wild = true,
                _ => {}
            },
            (Word::Load, [name]) => {
                let known = match name.value {
                    Some(Value::Name(id)) => self.lookup(id),
                    _ => Known::ANY,
                };
                self.state.stack.push(known);
            }
            (Word::Get, [container, _]) if container.kinds == Kinds::ARRAY => self.push(container.elements),
            (Word::Reverse | Word::Subarray, [a, ..]) | (Word::Copy, [a]) => {
                let kinds = if word == Word::Copy { a.kinds } else { Kinds::ARRAY };
                self.state.stack.push(Known { elements: a.elements, ..Known::of(kinds) });
            }
            (Word::Add | Word::Sub, [a, b]) => {
                let known = a.kinds.within(Kinds::LINEAR) && b.kinds.within(Kinds::LINEAR);
                if known && !a.kinds.meets(b.kinds) {
                    let name = word.signature().name;
                    let [a, b] = [a, b].map(|known| known.kinds.describe());
                    return Err(End::Mistake(at, format!("`{name}` cannot take {a} and {b}")));
                }
                self.push(if known { a.kinds.and(b.kinds) } else { Kinds::LINEAR });
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

    fn roll(&mut self, at: usize, count: &Known, turns: &Known) -> Result<(), End> {
        let (Some(count), Some(Value::Number(turns))) = (number(count), turns.value) else {
            self.state.forget_stack();
            return Ok(());
        };
        match self.state.stack.len().checked_sub(count) {
            Some(start) if count > 0 => {
                let turns = (turns as i64).rem_euclid(count as i64) as usize;
                self.state.stack[start..].rotate_right(turns);
            }
            Some(_) => {}
            None if self.state.open => self.state.forget_stack(),
            None => return Err(shallow(at, Word::Roll)),
        }
        Ok(())
    }

    /// Place of the topmost mark; `None` when it is not known.
    fn mark(&self, at: usize) -> Result<Option<usize>, End> {
        let stack = &self.state.stack;
        match stack.iter().rposition(|known| known.kinds.meets(Kinds::MARK)) {
            None if self.state.open => Ok(None),
            None => Err(End::Mistake(at, "there is no mark on the stack".to_owned())),
            // A value of unknown kind is rather no mark, if there is a certain one.
            Some(_) => Ok(stack.iter().rposition(|known| known.kinds == Kinds::MARK)),
        }
    }

    /// Takes everything down to the mark; gives the kinds of what was above it.
    fn clear_to_mark(&mut self, at: usize) -> Result<Kinds, End> {
        let Some(mark) = self.mark(at)? else {
            self.state.forget_stack();
            return Ok(Kinds::ANY);
        };
        let kinds = self.state.stack[mark + 1..].iter().map(|known| known.kinds).reduce(Kinds::or);
        self.state.stack.truncate(mark);
        Ok(kinds.unwrap_or(Kinds::ANY))
    }

    fn note_effect(&mut self, word: Word, taken: &[Known]) {
        match (word, taken) {
            (Word::AttrSet | Word::AttrDel | Word::LinkSet | Word::LinkDel, [element, key, rest @ ..]) => {
                let (Some(Value::Text(key)) | Some(Value::Name(key))) = key.value else {
                    let sets = matches!(word, Word::AttrSet | Word::LinkSet);
                    self.effects.sets_more |= sets;
                    self.effects.deletes_more |= !sets;
                    return;
                };
                let value = rest.first().and_then(|value| value.value);
                let effect = Effect { word, node: element.node, key, value };
                if !self.effects.annotations.contains(&effect) {
                    self.effects.annotations.push(effect);
                }
            }
            (Word::MoveV | Word::MoveE | Word::MoveF, _) => self.effects.moves = true,
            (Word::SharpE | Word::SharpF | Word::SharpV | Word::SetSharpness, _) => self.effects.moves = true,
            _ => self.effects.topology |= word.signature().edits,
        }
    }
}

fn number(known: &Known) -> Option<usize> {
    match known.value {
        Some(Value::Number(x)) if x >= 0.0 && x.fract() == 0.0 && x < 1e6 => Some(x as usize),
        _ => None,
    }
}

fn shallow(at: usize, word: Word) -> End {
    End::Mistake(at, format!("`{}` reaches below the bottom of the stack", word.signature().name))
}
