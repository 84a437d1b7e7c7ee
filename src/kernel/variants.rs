//! Kernels that were reflected and finished already. Same key, same `Arc`, so that stages that run the same program
//! compile it once.

use super::finish::{Choice, Program, Selection, VariantKey, finish};
use super::reflect::{Reflected, reflect};
use super::{Composed, Segment};
use crate::problem::Result;
use std::collections::{BTreeMap, HashMap};
use std::sync::Arc;

/// What [`reflect`] depends on.
type ReflectionKey = (Arc<str>, Arc<[Segment]>, BTreeMap<String, u64>);

/// A cache of kernels. It holds what it has seen until it is dropped or [cleared](Variants::clear); problems are not
/// kept.
#[derive(Debug, Default)]
pub struct Variants {
    reflected: HashMap<ReflectionKey, Arc<Reflected>>,
    programs: HashMap<VariantKey, Arc<Program>>,
    /// Programs that were there already, and that were made.
    pub hits: u64,
    pub misses: u64,
}

impl Variants {
    /// As [`reflect`], once for each text and values of what it declares.
    pub fn reflect(
        &mut self,
        composed: &Composed,
        overrides: &BTreeMap<String, f64>,
    ) -> Result<Arc<Reflected>> {
        let known = overrides.iter().filter(|(name, _)| composed.declarations.contains_key(*name));
        let values = known.map(|(name, value)| (name.clone(), value.to_bits())).collect();
        let key = (composed.text.clone(), composed.segments.clone(), values);
        if let Some(known) = self.reflected.get(&key) {
            return Ok(known.clone());
        }
        let reflected = Arc::new(reflect(composed, overrides)?);
        self.reflected.insert(key, reflected.clone());
        Ok(reflected)
    }

    /// As [`finish`], once for each key.
    pub fn finish(
        &mut self,
        reflected: &Reflected,
        entries: &[&str],
        choice: &Choice,
    ) -> Result<Arc<Program>> {
        let key = Selection::new(reflected, entries)?.key(choice);
        if let Some(known) = self.programs.get(&key) {
            self.hits += 1;
            return Ok(known.clone());
        }
        self.misses += 1;
        let program = Arc::new(finish(reflected, entries, choice)?);
        self.programs.insert(key, program.clone());
        Ok(program)
    }

    pub fn clear(&mut self) {
        self.reflected.clear();
        self.programs.clear();
    }
}
