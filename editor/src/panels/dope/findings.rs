//! The lane of problems below the ruler: a mark at the worst frame of each, with a fix in its menu.

use super::sheet::Sheet;
use crate::panels::commands::Id;
use crate::panels::context::PanelContext;
use crate::panels::request::Request;
use crate::panels::ruler::frame_of;
use crate::panels::theme::Theme;
use dragonfly_anim::lint::{LintFinding, LintRule};
use dragonfly_document::Change;
use dragonfly_document::edit::{
    BoneRef, CurveFilter, Edit, FilterKeys, KeySet, ReduceKeys, TurnKeys, TurnWay,
};
use egui::accesskit::Role;
use egui::{
    Button, CornerRadius, CursorIcon, PointerButton, Rect, Sense, Shape, Stroke, Ui, WidgetInfo, pos2, vec2,
};

/// Largest number of marks in the lane.
const MOST: usize = 300;

/// Draws the marks in sight.
pub(super) fn show(ui: &Ui, sheet: &Sheet<'_>, requests: &mut Vec<Request>) {
    let Sheet { areas, scale, context, theme, .. } = *sheet;
    let lane = areas.findings;
    let findings = context.take_findings();
    if findings.is_empty() || lane.height() < 4.0 {
        return;
    }
    ui.painter().rect_filled(lane, CornerRadius::ZERO, theme.bar);
    let painter = ui.painter().with_clip_rect(lane.intersect(ui.clip_rect()));
    for (index, finding) in findings.iter().take(MOST).enumerate() {
        let center = pos2(scale.x_of(finding.time), lane.center().y);
        let grip = Rect::from_center_size(center, vec2(10.0, lane.height()));
        if !grip.intersects(lane) {
            continue;
        }
        let id = ui.scope_id().with(("problem", index));
        let response = ui.interact(grip.intersect(lane), id, Sense::click());
        let (title, name) = (title(finding.rule), context.bone_name(finding.bone));
        response.widget_info(|| WidgetInfo::labeled(Role::Button, true, format!("{title}: {name}")));
        let color = if response.hovered() { theme.warning } else { theme.warning.gamma_multiply(0.8) };
        let corners = vec![center + vec2(-4.0, 3.5), center + vec2(4.0, 3.5), center + vec2(0.0, -3.5)];
        painter.add(Shape::convex_polygon(corners, color, Stroke::NONE));
        let (frame, unit) = (frame_of(finding.time, context.frame_rate), finding.rule.unit());
        let fix = fix(finding, context);
        let hint =
            if fix.is_some() { "Click to go there, right-click to fix it" } else { "Click to go there" };
        let response = response
            .on_hover_cursor(CursorIcon::PointingHand)
            .on_hover_text(format!("{title}: {name}, frame {frame}, {:.1} {unit}\n{hint}", finding.amount));
        if response.clicked_by(PointerButton::Primary) {
            requests.push(Request::Select(Some(finding.bone)));
            requests.push(Request::Seek(finding.time));
        }
        response.context_menu(|ui| match fix {
            Some((title, request)) => {
                if ui.add(Button::new(title).frame_when_inactive(false)).clicked() {
                    requests.push(request);
                    ui.close();
                }
            }
            None => {
                ui.label(egui::RichText::new("There is no automatic fix").color(Theme::of(ui).weak));
            }
        });
    }
}

/// Returns the title of a rule.
fn title(rule: LintRule) -> &'static str {
    match rule {
        LintRule::Jitter => "Jitter",
        LintRule::FootSlide => "Foot slide",
        LintRule::Floor => "Below the floor",
        LintRule::Pop => "Jump",
        LintRule::Flip => "Flip",
        LintRule::Stretch => "Stretched bone",
        LintRule::JointLimit => "Beyond the limit of the joint",
        LintRule::LoopGap => "Gap of the loop",
        LintRule::SpareKeys => "Keys without need",
        LintRule::Outside => "Key outside of the take",
    }
}

/// Returns the title of the fix for a problem and its request; `None` where no edit fixes it.
fn fix(finding: &LintFinding, context: &PanelContext<'_>) -> Option<(String, Request)> {
    let take = context.shown_take_ref()?;
    let name = context.bone_name(finding.bone);
    let keys = || vec![KeySet { bones: vec![BoneRef::Index(finding.bone)], ..KeySet::default() }];
    let edit = |title: String, edit: Edit| Some((title, Request::Change(Change::Edit(edit, None))));
    let filter = |filter: CurveFilter| {
        Edit::FilterKeys(FilterKeys {
            take: take.clone(),
            keys: keys(),
            shapes: Vec::new(),
            filter,
            rate: None,
            hold: context.held_feet(),
        })
    };
    match finding.rule {
        LintRule::FootSlide => Some(("Lock feet in contacts".to_owned(), Request::Command(Id::LockContacts))),
        LintRule::LoopGap => Some(("Loop…".to_owned(), Request::Command(Id::LoopDialog))),
        LintRule::Jitter => {
            edit(format!("Smooth {name} (6 Hz)"), filter(CurveFilter::Butterworth { cutoff: 6.0, order: 2 }))
        }
        LintRule::Pop => {
            edit(format!("Remove peaks of {name}"), filter(CurveFilter::Peaks { window: 5, threshold: 2.0 }))
        }
        LintRule::Flip => {
            let turn = TurnKeys { take: take.clone(), keys: keys(), way: TurnWay::Shortest };
            edit(format!("Turn {name} the short way"), Edit::TurnKeys(turn))
        }
        LintRule::SpareKeys => {
            let reduce = ReduceKeys {
                take: take.clone(),
                keys: keys(),
                tolerance: 1.0,
                unit: Some(context.unit.millimeters().into()),
            };
            edit(format!("Reduce keys of {name} (1 mm)"), Edit::ReduceKeys(reduce))
        }
        LintRule::Floor | LintRule::Stretch | LintRule::JointLimit | LintRule::Outside => None,
    }
}
