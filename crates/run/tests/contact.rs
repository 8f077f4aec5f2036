//! Contacts in scenes: beside bonds, beside the limit of the step, with attraction.

mod beside_bond;
mod beside_limit;
mod dmt_scenes;
mod impact_accuracy;
