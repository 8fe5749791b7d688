//! A renderer that the validation layers watch, for all test crates that draw.

use ash::vk;
use selvedge::gpu::LowerLimits;
use selvedge::headless::{HeadlessDevice, HeadlessOptions, HeadlessRenderer};
use selvedge::model::Model;
use selvedge::picture::Outputs;
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// A sample of the repository. The test fails if the file is missing.
#[allow(dead_code)] // some test binaries use no samples
pub fn sample(name: &str) -> Model {
    // a packed test binary runs where the source tree does not exist: the environment names the folder
    let root = std::env::var("CARGO_MANIFEST_DIR").unwrap_or_else(|_| env!("CARGO_MANIFEST_DIR").to_owned());
    selvedge_io::import::open(&Path::new(&root).join("samples").join(name)).unwrap().model
}

/// A renderer without a model, under validation and synchronisation validation, for pictures with all images of points.
pub fn renderer() -> HeadlessRenderer {
    let idle = lock(&IDLE).pop();
    let renderer = match idle {
        Some(device) => HeadlessRenderer::on(device).unwrap(),
        None => {
            let made = limited(LowerLimits::NONE);
            lock(&USES).insert(made.device().device().raw().handle(), 0);
            made
        }
    };
    expecting(renderer)
}

/// The same on a device of its own, with lower limits.
pub fn limited(lower: LowerLimits) -> HeadlessRenderer {
    let options = HeadlessOptions { validation: true, ..Default::default() };
    let renderer = HeadlessRenderer::limited(&options, lower);
    let renderer = renderer.unwrap_or_else(|error| panic!("these tests need Vulkan: {error}"));
    // a device of a test that failed may have had this handle
    lock(&USES).remove(&renderer.device().device().raw().handle());
    expecting(renderer)
}

fn expecting(mut renderer: HeadlessRenderer) -> HeadlessRenderer {
    renderer.expect(Outputs::ALL);
    renderer
}

/// Devices whose renderer has ended. Under validation a device and its pipelines take longer than most tests, so the
/// tests of a process hand them on.
static IDLE: Mutex<Vec<HeadlessDevice>> = Mutex::new(Vec::new());
/// How many renderers each of these devices has had.
static USES: Mutex<BTreeMap<vk::Device, u32>> = Mutex::new(BTreeMap::new());
/// After so many renderers a device is destroyed: only then do the layers tell what was never freed. They tell nothing
/// of devices that are idle at the end of the process.
const MOST_USES: u32 = 8;

/// Ends the renderer; any message of the layers fails the test, and so does any object that is left.
pub fn assert_silent(renderer: HeadlessRenderer) {
    let handle = renderer.device().device().raw().handle();
    let uses = lock(&USES).get_mut(&handle).map(|uses| {
        *uses += 1;
        *uses
    });
    renderer.device().keep_pipelines();
    let device = renderer.into_device();
    let left = device.device().objects();
    assert!(left.is_empty(), "alive after their renderer: {}", left.join(", "));
    let messages = match uses {
        // where each test has a process, no test comes after this one
        Some(uses) if uses < MOST_USES && std::env::var_os("NEXTEST").is_none() => {
            let messages = device.take_messages();
            lock(&IDLE).push(device);
            messages
        }
        _ => {
            lock(&USES).remove(&handle);
            device.shutdown()
        }
    };
    let messages: Vec<_> = messages.iter().map(ToString::to_string).collect();
    assert!(messages.is_empty(), "messages about this test, or leaks of one before it:\n{}", messages.join("\n"));
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
