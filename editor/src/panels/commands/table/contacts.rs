//! Contacts of bones with the ground: found, added, deleted, locked.

use super::*;
use crate::panels::actions::contacts;
use crate::panels::prompts::Overlay;

commands! {
    DetectContacts => When::Take, "Detect contacts", [], "Finds when feet touch the ground, by height and speed, and shows it on the timeline: of the selected bones, or of the bones called feet (plant)", contacts::detect;
    AddContact => When::BoneInTake, "Add contact", [], "Adds a contact of the selected bones with the ground over the play range", contacts::add;
    LockContacts => When::Take, "Lock feet in contacts", [], "Holds feet where they touch the ground, so that they do not slide: in the contacts of the take, or in those found by height and speed (plant, foot slide)", contacts::lock;
    ToggleHoldFeet => When::Always, "Hold feet while smoothing", [], "Lets smoothing, noise and removal of peaks leave feet where they are planted, in the contacts of the take; keys are added there (plant, foot slide)", |w| { w.keys.toggle_hold_feet(); None };
    ModelSize => When::Model, "Size of the model…", [], "Shows how tall the figure is taken to be, and sets how many meters one unit of its file is, for contacts, foot slide and all other distances (scale, centimeters, unit)", |w| { w.prompts.show(Some(Overlay::ModelSize)); None };
    DeleteContacts => When::Contacts, "Delete contacts", [], "Deletes the contacts of the selected bones, or all of the take if none of these has any; no key changes", contacts::delete;
}
