//! What a spec chooses besides its method, such as `over_pi`: of each list of its family one at most, in the lists' order.

use crate::families::all::ALL;
use crate::families::family::{Family, Proof, Spec};

/// Returns the lists that specs of a name choose from.
pub fn of_name(name: &str) -> &'static [&'static [&'static str]] {
    ALL.iter().find(|family| family.name == name).map_or(&[], |family| family.choices)
}

impl Spec {
    /// The spec with another choice of the family's.
    ///
    /// # Panics
    ///
    /// If the family has no such choice.
    #[must_use]
    pub fn choosing(mut self, choice: &str) -> Self {
        let lists = self.family.choices;
        let list = lists.iter().find(|list| list.contains(&choice)).expect("the family has the choice");
        self.chosen.retain(|chosen| !list.contains(chosen));
        self.chosen.extend(list.iter().filter(|name| **name == choice));
        let place = |name: &&str| lists.iter().position(|list| list.contains(name));
        self.chosen.sort_by_key(place);
        self
    }

    /// Returns whether it chooses this.
    pub fn has(&self, choice: &str) -> bool {
        self.chosen.contains(&choice)
    }

    /// Returns how its error is proven.
    pub fn proof(&self) -> Proof {
        let is_open = self.family.unproven.iter().any(|choice| self.has(choice));
        if is_open { Proof::Nothing } else { self.family.proof }
    }

    /// Returns the spec of another family of the same order and choices.
    pub fn sibling(&self, family: &'static Family) -> Self {
        Self { chosen: self.chosen.clone(), ..Self::new(family, self.order) }
    }

    /// Returns the spec with one more choice, or what is wrong with that and what to do.
    pub(super) fn also(self, choice: &str) -> Result<Self, [String; 2]> {
        let list = self.family.choices.iter().find(|list| list.contains(&choice));
        let other = list.and_then(|list| list.iter().find(|other| self.has(other)));
        let message = match other {
            None => return Ok(self.choosing(choice)),
            Some(other) if *other == choice => format!("`{choice}` stands twice"),
            Some(other) => format!("`{other}` and `{choice}` exclude each other"),
        };
        Err([message, "leave one out".to_owned()])
    }
}
