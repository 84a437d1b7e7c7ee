//! A first walk over the JSON text, before anything is made of it: how much it will be in memory, and what the types of
//! the document don't notice. Those keep the last of several members of one name, and cut integers to 32 bits.

use gltf::json::Error;
use serde::de::{DeserializeSeed, Deserializer, MapAccess, SeqAccess, Visitor};
use std::collections::HashSet;
use std::fmt;

/// Bytes that an object, and any other value, take at most in the types of a document.
const OBJECT: u64 = 1024;
const VALUE: u64 = 48;

/// Members that hold an index or the number of a kind, of 32 bits; in lists of that name all items do.
const NARROW: [&str; 31] = [
    "buffer",
    "bufferView",
    "byteStride",
    "camera",
    "children",
    "componentType",
    "indices",
    "index",
    "input",
    "inverseBindMatrices",
    "joints",
    "light",
    "magFilter",
    "material",
    "mesh",
    "minFilter",
    "mode",
    "node",
    "nodes",
    "output",
    "sampler",
    "scene",
    "skeleton",
    "skin",
    "source",
    "target",
    "texCoord",
    "variants",
    "wrapS",
    "wrapT",
    "mapping",
];

/// The bytes that the document in a JSON text will take at most. Errors: a text that is no JSON, one nested more than
/// 128 deep, members of one name, indices that no list can have.
pub fn census(json: &[u8]) -> Result<u64, Error> {
    let mut text = serde_json::Deserializer::from_slice(json);
    let mut bytes = 0;
    let place = Place { up: None, name: Name::Whole };
    Walk { bytes: &mut bytes, place: &place, free: false }.deserialize(&mut text)?;
    text.end()?;
    Ok(bytes)
}

/// Where a value stands; the outermost names last.
struct Place<'a> {
    up: Option<&'a Place<'a>>,
    name: Name<'a>,
}

enum Name<'a> {
    Whole,
    Member(&'a str),
    Item(usize),
}

impl Place<'_> {
    /// The name of the member that this is, or is an item of.
    fn member(&self) -> Option<&str> {
        match self.name {
            Name::Whole => None,
            Name::Member(name) => Some(name),
            Name::Item(_) => self.up?.member(),
        }
    }

    /// Whether a number here is cut to 32 bits.
    fn is_narrow(&self) -> bool {
        let list = self.up.and_then(Place::member);
        matches!(list, Some("attributes" | "targets"))
            || self.member().is_some_and(|name| NARROW.contains(&name))
    }
}

/// As a JSON pointer.
impl fmt::Display for Place<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(up) = self.up {
            up.fmt(f)?;
        }
        match self.name {
            Name::Whole => Ok(()),
            Name::Member(name) => write!(f, "/{}", name.replace('~', "~0").replace('/', "~1")),
            Name::Item(index) => write!(f, "/{index}"),
        }
    }
}

struct Walk<'a> {
    bytes: &'a mut u64,
    place: &'a Place<'a>,
    /// Within `extras`, where any number may stand.
    free: bool,
}

impl<'a> Walk<'a> {
    fn at<'b>(&'b mut self, place: &'b Place<'b>) -> Walk<'b> {
        let free = self.free || matches!(place.name, Name::Member("extras"));
        Walk { bytes: self.bytes, place, free }
    }

    fn number<E: serde::de::Error>(self, number: f64) -> Result<(), E> {
        *self.bytes += VALUE;
        if number >= f64::from(u32::MAX) && !self.free && self.place.is_narrow() {
            return Err(E::custom(format_args!("{number} at {} is no index or kind", self.place)));
        }
        Ok(())
    }
}

impl<'de> DeserializeSeed<'de> for Walk<'_> {
    type Value = ();

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<(), D::Error> {
        deserializer.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for Walk<'_> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a JSON value")
    }

    fn visit_unit<E>(self) -> Result<(), E> {
        *self.bytes += VALUE;
        Ok(())
    }

    fn visit_bool<E>(self, _: bool) -> Result<(), E> {
        *self.bytes += VALUE;
        Ok(())
    }

    fn visit_str<E>(self, text: &str) -> Result<(), E> {
        *self.bytes += VALUE + text.len() as u64;
        Ok(())
    }

    fn visit_i64<E: serde::de::Error>(self, number: i64) -> Result<(), E> {
        self.number(number as f64)
    }

    fn visit_u64<E: serde::de::Error>(self, number: u64) -> Result<(), E> {
        self.number(number as f64)
    }

    fn visit_f64<E: serde::de::Error>(self, number: f64) -> Result<(), E> {
        self.number(number)
    }

    fn visit_seq<A: SeqAccess<'de>>(mut self, mut items: A) -> Result<(), A::Error> {
        *self.bytes += VALUE;
        let up = self.place;
        for index in 0.. {
            let place = Place { up: Some(up), name: Name::Item(index) };
            if items.next_element_seed(self.at(&place))?.is_none() {
                break;
            }
        }
        Ok(())
    }

    fn visit_map<A: MapAccess<'de>>(mut self, mut members: A) -> Result<(), A::Error> {
        *self.bytes += OBJECT;
        let up = self.place;
        let mut names = HashSet::new();
        while let Some(name) = members.next_key::<String>()? {
            let place = Place { up: Some(up), name: Name::Member(&name) };
            *self.bytes += VALUE + name.len() as u64;
            if names.contains(&name) {
                return Err(serde::de::Error::custom(format_args!("{place} is there twice")));
            }
            members.next_value_seed(self.at(&place))?;
            names.insert(name);
        }
        Ok(())
    }
}
