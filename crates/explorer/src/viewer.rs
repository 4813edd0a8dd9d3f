//! The embedded Rerun viewer: a pane of the window that receives its data in-process. Its own panels are hidden,
//! because the window has panels of its own.

use std::cell::RefCell;
use std::rc::Rc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use eframe::App as _;
use egui::{Context, Event, Rect, Ui};
use glam::{DQuat, DVec2, DVec3};
use re_viewer::external::re_chunk_store::MissingChunkReporter;
use re_viewer::external::re_log_types::Instance;
use re_viewer::external::re_sdk_types::blueprint::components::PanelState;
use re_viewer::external::re_view_spatial::SpatialViewState;
use re_viewer::external::re_viewer_context::{
    IdentifiedViewSystem, Item, ItemContext, ViewContext, ViewContextSystem, ViewContextSystemOncePerFrameResult,
    ViewQuery, ViewSystemIdentifier, ViewerContext,
};
use re_viewer::external::{re_memory, tokio};
use re_viewer::{
    AppEnvironment, AsyncRuntimeHandle, MainThreadToken, SelectionChangeItem, StartupOptions, ViewerEvent,
    ViewerEventKind,
};

use super::eye::{Eye, SceneView};
use super::pointing::Pointed;
use kinefront_recording::{APPLICATION_ID, LiveScene, Picked};
use kinefront_study::Study;

/// Memory \[bytes\] that the scene may use before its oldest data are dropped.
const MEMORY: u64 = 2 << 30;

/// The embedded viewer.
pub struct Viewer {
    app: re_viewer::App,
    events: Rc<RefCell<Vec<ViewerEvent>>>,
    /// Whether key presses go to the viewer, that is, whether the last click was inside it.
    owns_keys: Arc<AtomicBool>,
    /// Rectangle that the viewer filled in the last frame; none if it was not drawn.
    pane: Rect,
    _runtime: tokio::runtime::Runtime,
}

/// Removes the events of keys from the input and returns them, so that the viewer does not receive them.
fn take_keys(ctx: &Context) -> Vec<Event> {
    ctx.input_mut(|input| {
        let (keys, rest) = std::mem::take(&mut input.events)
            .into_iter()
            .partition(|event| matches!(event, Event::Key { .. } | Event::Copy | Event::Cut));
        input.events = rest;
        keys
    })
}

/// Options of a viewer that shows views alone and stores the events in `events`.
fn startup_options(events: Rc<RefCell<Vec<ViewerEvent>>>) -> StartupOptions {
    let mut options = StartupOptions {
        persist_state: false,
        // The welcome screen would load examples from the internet.
        hide_welcome_screen: true,
        expect_data_soon: Some(true),
        // This is called while the renderer is locked, so it must do nothing but store the event.
        on_event: Some(Rc::new(move |event| events.borrow_mut().push(event))),
        ..StartupOptions::default()
    };
    let panels = &mut options.panel_state_overrides;
    panels.top = Some(PanelState::Hidden);
    panels.blueprint = Some(PanelState::Hidden);
    panels.selection = Some(PanelState::Hidden);
    panels.time = Some(PanelState::Hidden);
    options
}

/// Keys that the viewer must not see in this pass.
type KeysAside = Arc<Mutex<Vec<Event>>>;

/// The viewer processes keys at the beginning of each pass. They are removed before that and restored after it, unless the
/// last click was inside the viewer.
fn take_keys_aside(cc: &eframe::CreationContext<'_>, owns_keys: &Arc<AtomicBool>) -> KeysAside {
    let aside = KeysAside::default();
    let (owned, put) = (Arc::clone(owns_keys), Arc::clone(&aside));
    cc.egui_ctx.on_begin_pass(
        "kinefront-keys-aside",
        Arc::new(move |ui| {
            if !owned.load(Ordering::Relaxed) {
                *put.lock().unwrap_or_else(PoisonError::into_inner) = take_keys(ui);
            }
        }),
    );
    aside
}

/// Restores the keys; must be registered after the viewer, so that it runs after it.
fn put_keys_back(cc: &eframe::CreationContext<'_>, aside: KeysAside) {
    cc.egui_ctx.on_begin_pass(
        "kinefront-keys-back",
        Arc::new(move |ui| {
            let keys = std::mem::take(&mut *aside.lock().unwrap_or_else(PoisonError::into_inner));
            ui.input_mut(|input| input.events.extend(keys));
        }),
    );
}

impl Viewer {
    /// Makes the viewer and the scene that it shows.
    ///
    /// # Errors
    /// Returns an error if the graphics card cannot draw the viewer or its threads cannot be started.
    pub fn new(
        cc: &eframe::CreationContext<'_>,
        study: &Study,
    ) -> Result<(Self, LiveScene), Box<dyn std::error::Error + Send + Sync>> {
        re_viewer::customize_eframe_and_setup_renderer(cc)?;
        let runtime = tokio::runtime::Builder::new_multi_thread()
            .worker_threads(1)
            .enable_all()
            .build()?;
        let events: Rc<RefCell<Vec<ViewerEvent>>> = Rc::default();
        let owns_keys = Arc::new(AtomicBool::new(false));
        let aside = take_keys_aside(cc, &owns_keys);
        let mut app = re_viewer::App::new(
            MainThreadToken::i_promise_i_am_on_the_main_thread(),
            re_viewer::build_info(),
            AppEnvironment::Custom(APPLICATION_ID.to_owned()),
            startup_options(Rc::clone(&events)),
            cc,
            // With its own registry, the viewer does not look for stored credentials.
            Some(re_redap_client::ConnectionRegistry::new_without_stored_credentials()),
            AsyncRuntimeHandle::new_native(runtime.handle().clone()),
        );
        put_keys_back(cc, aside);
        app.extend_view_class("3D".into(), |registrator| {
            registrator.register_context_system::<PointerProbe>()
        })?;
        let settings = app.app_options_mut();
        settings.custom_window_decorations = false;
        settings.show_notification_toasts = false;
        settings.show_metrics = false;
        settings.include_rerun_examples_button_in_recordings_panel = false;
        settings.memory_limit = re_memory::MemoryLimit::from_bytes(MEMORY);

        let (sender, receiver) = re_log_channel::log_channel(re_log_channel::LogSource::Sdk);
        app.add_log_receiver(receiver);
        let sink = rerun::sink::CallbackSink::new(move |messages| {
            for message in messages {
                // The send fails only if the viewer is already closed.
                let _ = sender.send(message.clone().into());
            }
        });
        let scene = LiveScene::new(Box::new(sink), study)?;
        let viewer = Self {
            app,
            events,
            owns_keys,
            pane: Rect::NOTHING,
            _runtime: runtime,
        };
        Ok((viewer, scene))
    }

    /// Processes the received data; must be called before each frame.
    pub fn logic(&mut self, ctx: &Context, frame: &mut eframe::Frame) {
        // Its tab may be behind another one in this frame.
        self.pane = Rect::NOTHING;
        self.app.logic(ctx, frame);
    }

    /// Returns what the pointer is over in a 3-D view.
    pub fn pointed(&self) -> Option<Pointed> {
        seen().pointed.clone()
    }

    /// Returns the view of the selected design if the pointer was over it in the last frame.
    pub fn view_of_design(&self, ctx: &Context) -> Option<SceneView> {
        let eye = seen().eye?;
        let rect = ctx.viewport(|viewport| viewport.hits.drag.map(|widget| widget.rect))?;
        // The tabs of the viewer can be dragged as well.
        let is_view = self.pane.contains_rect(rect) && rect.height() > 0.5 * self.pane.height();
        is_view.then_some(SceneView { eye, rect })
    }

    /// Draws the viewer into a pane.
    pub fn ui(&mut self, ui: &mut Ui, frame: &mut eframe::Frame) {
        let pane = ui.max_rect();
        self.pane = pane;
        // The viewer's tooltips show the components of an entity, which mean nothing to a designer.
        let delay = ui.ctx().global_style().interaction.tooltip_delay;
        ui.ctx()
            .global_style_mut(|style| style.interaction.tooltip_delay = f32::INFINITY);
        if let Some(press) = ui.input(|input| input.pointer.press_origin()) {
            self.owns_keys.store(pane.contains(press), Ordering::Relaxed);
        }
        // Some shortcuts of the viewer close the program, erase its storage or open a port, so none is passed on.
        let keys = take_keys(ui.ctx());
        ui.push_id("scene", |ui| self.app.ui(ui, frame));
        ui.ctx().input_mut(|input| input.events.extend(keys));
        ui.ctx()
            .global_style_mut(|style| style.interaction.tooltip_delay = delay);
    }

    /// Returns what was clicked since the last call, if anything was.
    pub fn picked(&mut self) -> Option<Picked> {
        let mut picked = None;
        for event in self.events.borrow_mut().drain(..) {
            if let ViewerEventKind::SelectionChange { items } = event.kind {
                picked = items.iter().find_map(|item| match item {
                    // A selection without a position was not made by a click.
                    SelectionChangeItem::Entity {
                        entity_path,
                        instance_id,
                        position: Some(at),
                        ..
                    } => {
                        let at = DVec2::new(f64::from(at.x), f64::from(at.y));
                        LiveScene::picked(&entity_path.to_string(), instance_of(*instance_id), at)
                    }
                    _ => None,
                });
            }
        }
        picked
    }
}

/// What the system of the 3-D views notes in a frame.
struct Seen {
    /// What the pointer is over.
    pointed: Option<Pointed>,
    /// The eye of the view of the selected design, if it is shown.
    eye: Option<Eye>,
}

/// What was noted in the last frame. The viewer makes the systems of its views itself, so that they can be given nothing; there is one window.
fn seen() -> MutexGuard<'static, Seen> {
    static SEEN: Mutex<Seen> = Mutex::new(Seen {
        pointed: None,
        eye: None,
    });
    SEEN.lock().unwrap_or_else(PoisonError::into_inner)
}

/// System of the 3-D views that draws nothing: once per frame it notes what the pointer is over, and where the eye is.
#[derive(Default)]
struct PointerProbe;

impl IdentifiedViewSystem for PointerProbe {
    fn identifier() -> ViewSystemIdentifier {
        "KinefrontPointer".into()
    }
}

impl ViewContextSystem for PointerProbe {
    fn execute_once_per_frame(ctx: &ViewerContext<'_>) -> ViewContextSystemOncePerFrameResult {
        let selection = ctx.selection_state();
        let position = match selection.hovered_item_context() {
            Some(ItemContext::ThreeD { pos, .. }) => *pos,
            _ => None,
        };
        let pointed = selection.hovered_items().iter_items().next().and_then(|item| {
            let at = position?;
            let instance = match item {
                Item::InstancePath(path) => path,
                Item::DataResult(result) => &result.instance_path,
                _ => return None,
            };
            Some(Pointed {
                entity: instance.entity_path.to_string(),
                instance: instance_of(instance.instance),
                at: DVec2::new(f64::from(at.x), f64::from(at.y)),
            })
        });
        *seen() = Seen { pointed, eye: None };
        Box::new(())
    }

    fn execute(
        &mut self,
        ctx: &ViewContext<'_>,
        _: &MissingChunkReporter,
        query: &ViewQuery<'_>,
        _: &ViewContextSystemOncePerFrameResult,
    ) {
        if !LiveScene::shows_design(&query.space_origin.to_string()) {
            return;
        }
        let state = ctx.view_state.as_any().downcast_ref::<SpatialViewState>();
        let eye = state
            .and_then(|state| state.state_3d.eye_state.last_eye)
            .and_then(|eye| {
                let at = eye.world_from_rub_view;
                let [x, y, z] = at.translation().to_array().map(f64::from);
                let rotation = at.rotation().to_array().map(f64::from);
                Some(Eye {
                    position: DVec3::new(x, y, z),
                    rotation: DQuat::from_array(rotation).normalize(),
                    fov_y: f64::from(eye.fov_y?),
                })
            });
        seen().eye = eye;
    }
}

/// Returns the memory that the program occupies \[bytes\], if the system tells it.
pub fn resident_memory() -> Option<u64> {
    re_memory::MemoryUse::capture().resident
}

/// Returns the index of the instance: 0 for a whole batch, because a batch of one is selected as a whole.
fn instance_of(instance: Instance) -> Option<u64> {
    Some(instance.specific_index().map_or(0, |index| index.get()))
}
