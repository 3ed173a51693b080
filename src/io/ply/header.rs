//! The header of a PLY file: which elements follow, and of what they consist.

use crate::io::text::{Cursor, Fault, Place, shown};

/// How the numbers of the body are stored.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Storage {
    Ascii,
    BinaryLittleEndian,
    BinaryBigEndian,
}

/// A kind of number.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

/// A property of an element: one number, or a list with its count in front.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) struct Property {
    pub(super) name: String,
    /// The kind of the count, for a list.
    pub(super) count: Option<Scalar>,
    pub(super) scalar: Scalar,
    pub(super) line: u32,
}

/// An element, such as all vertices.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) struct Element {
    pub(super) name: String,
    pub(super) count: u64,
    pub(super) properties: Vec<Property>,
    pub(super) place: Place,
}

#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) struct Header {
    pub(super) storage: Storage,
    pub(super) elements: Vec<Element>,
}

impl Scalar {
    fn parse(name: &[u8]) -> Option<Self> {
        Some(match name {
            b"char" | b"int8" => Self::I8,
            b"uchar" | b"uint8" => Self::U8,
            b"short" | b"int16" => Self::I16,
            b"ushort" | b"uint16" => Self::U16,
            b"int" | b"int32" => Self::I32,
            b"uint" | b"uint32" => Self::U32,
            b"float" | b"float32" => Self::F32,
            b"double" | b"float64" => Self::F64,
            _ => return None,
        })
    }
}

/// Reads the header; leaves `text` at the first byte of the body.
pub(super) fn read(text: &mut Cursor) -> Result<Header, Box<Fault>> {
    const REMEDY: &str = "check that this is a PLY file (version 1.0) and that its header is whole";
    let fault = |text: &Cursor, message: String| {
        Box::new(Fault { place: text.place(), message, remedy: REMEDY, memory: None })
    };
    if text.token() != b"ply" {
        return Err(fault(text, "the file does not begin with 'ply'".into()));
    }
    let mut storage = None;
    let mut elements: Vec<Element> = Vec::new();
    loop {
        if !text.end_line() {
            return Err(fault(text, "the header has no 'end_header'".into()));
        }
        text.next_token_on_line();
        let place = text.place();
        match text.token() {
            b"" | b"comment" | b"obj_info" => {}
            b"end_header" => {
                text.end_line();
                break;
            }
            b"format" => {
                storage = Some(match word(text) {
                    b"ascii" => Storage::Ascii,
                    b"binary_little_endian" => Storage::BinaryLittleEndian,
                    b"binary_big_endian" => Storage::BinaryBigEndian,
                    other => return Err(fault(text, format!("'{}' is no format of PLY", shown(other)))),
                });
            }
            b"element" => {
                let name = shown(word(text));
                let token = word(text);
                let count = std::str::from_utf8(token).ok().and_then(|count| count.parse().ok());
                let Some(count) = count else {
                    return Err(fault(text, format!("'{}' is not a number of elements", shown(token))));
                };
                elements.push(Element { name, count, properties: Vec::new(), place });
            }
            b"property" => {
                let (count, kind) = match word(text) {
                    b"list" => (Some(word(text)), word(text)),
                    kind => (None, kind),
                };
                let name = shown(word(text));
                let count = count.map(|kind| Scalar::parse(kind).ok_or(kind)).transpose();
                let (count, scalar) = match (count, Scalar::parse(kind).ok_or(kind)) {
                    (Ok(count), Ok(scalar)) => (count, scalar),
                    (Err(kind), _) | (_, Err(kind)) => {
                        return Err(fault(text, format!("'{}' is no kind of number", shown(kind))));
                    }
                };
                let Some(element) = elements.last_mut() else {
                    return Err(fault(text, "a property before the first element".into()));
                };
                element.properties.push(Property { name, count, scalar, line: place.line });
            }
            other => return Err(fault(text, format!("'{}' is no keyword of a PLY header", shown(other)))),
        }
    }
    match storage {
        Some(storage) => Ok(Header { storage, elements }),
        None => Err(fault(text, "the header has no 'format'".into())),
    }
}

/// The next token of the line, empty at its end.
fn word<'a>(text: &mut Cursor<'a>) -> &'a [u8] {
    text.next_token_on_line();
    text.token()
}
