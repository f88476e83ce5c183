//! The dope sheet in one frame, as its parts read it.

use super::areas::DopeAreas;
use super::rows::DopeRows;
use crate::panels::context::PanelContext;
use crate::panels::keys::{Drawn, TimeScale};
use crate::panels::theme::Theme;

/// Height of a row.
pub(in crate::panels) const ROW: f32 = 20.0;

/// Everything that the parts of the dope sheet read in one frame.
#[derive(Clone, Copy)]
pub(super) struct Sheet<'a> {
    pub(super) areas: &'a DopeAreas,
    pub(super) rows: &'a DopeRows,
    /// Number of points by which the rows are scrolled up.
    pub(super) scroll: f32,
    pub(super) scale: &'a TimeScale,
    pub(super) drawn: &'a Drawn,
    pub(super) context: &'a PanelContext<'a>,
    pub(super) theme: &'a Theme,
}
