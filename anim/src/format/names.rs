//! Unique names.

use std::collections::HashMap;

/// Names given so far.
#[derive(Default)]
pub(super) struct UniqueNames {
    /// The number to try next for each name.
    next: HashMap<String, u32>,
}

impl UniqueNames {
    /// Returns the name itself if it is not empty and no one has it yet, otherwise with a number at its end; and whether it is
    /// the name itself. An empty name becomes `bone`.
    pub(super) fn make(&mut self, name: String) -> (String, bool) {
        let name = if name.is_empty() { "bone".to_owned() } else { name };
        let Some(&first) = self.next.get(&name) else {
            self.next.insert(name.clone(), 2);
            return (name, true);
        };
        let mut number = first;
        let unique = loop {
            let candidate = format!("{name}_{number}");
            number = number.saturating_add(1);
            if !self.next.contains_key(&candidate) {
                break candidate;
            }
        };
        self.next.insert(name, number);
        self.next.insert(unique.clone(), 2);
        (unique, false)
    }
}
