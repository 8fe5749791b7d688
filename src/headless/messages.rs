//! Messages of the validation layers about one instance.

use ash::vk;
use std::ffi::{CStr, c_void};
use std::fmt;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// How bad a message is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub enum Severity {
    /// Probably not meant.
    Warning,
    /// Against the rules of Vulkan.
    Error,
}

/// A finding of the validation layers, or of the shutdown.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Message {
    /// How bad it is.
    pub severity: Severity,
    /// The rule that was broken: `VUID-…`, `SYNC-HAZARD-…`.
    pub id: String,
    /// What happened to which object.
    pub text: String,
}

impl fmt::Display for Message {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:?} {}: {}", self.severity, self.id, self.text)
    }
}

/// The messages of one instance. Shared with the layers by address, not through a global: tests run
/// several instances at once.
#[derive(Clone, Debug, Default)]
pub(super) struct Messages(Arc<Mutex<Vec<Message>>>);

impl Messages {
    fn lock(&self) -> MutexGuard<'_, Vec<Message>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    pub(super) fn push(&self, message: Message) {
        self.lock().push(message);
    }

    pub(super) fn all(&self) -> Vec<Message> {
        self.lock().clone()
    }

    pub(super) fn take(&self) -> Vec<Message> {
        std::mem::take(&mut self.lock())
    }

    /// A messenger that adds to these messages; they outlive it.
    pub(super) fn messenger(&self) -> vk::DebugUtilsMessengerCreateInfoEXT<'static> {
        vk::DebugUtilsMessengerCreateInfoEXT::default()
            .message_severity(
                vk::DebugUtilsMessageSeverityFlagsEXT::WARNING | vk::DebugUtilsMessageSeverityFlagsEXT::ERROR,
            )
            .message_type(vk::DebugUtilsMessageTypeFlagsEXT::VALIDATION)
            .pfn_user_callback(Some(on_message))
            .user_data(Arc::as_ptr(&self.0).cast_mut().cast())
    }
}

unsafe extern "system" fn on_message(
    severity: vk::DebugUtilsMessageSeverityFlagsEXT,
    _kind: vk::DebugUtilsMessageTypeFlagsEXT,
    data: *const vk::DebugUtilsMessengerCallbackDataEXT<'_>,
    user_data: *mut c_void,
) -> vk::Bool32 {
    // SAFETY: the address given to `messenger`; the instance's owner keeps the messages alive.
    let messages = unsafe { &*user_data.cast::<Mutex<Vec<Message>>>() };
    // SAFETY: Vulkan passes valid callback data and null or terminated strings.
    let (id, text) = unsafe { (string((*data).p_message_id_name), string((*data).p_message)) };
    let error = severity.contains(vk::DebugUtilsMessageSeverityFlagsEXT::ERROR);
    let severity = if error { Severity::Error } else { Severity::Warning };
    messages.lock().unwrap_or_else(PoisonError::into_inner).push(Message { severity, id, text });
    vk::FALSE
}

/// # Safety
/// `text` is null or a terminated string.
unsafe fn string(text: *const std::ffi::c_char) -> String {
    if text.is_null() {
        return String::new();
    }
    // SAFETY: as the caller promises.
    unsafe { CStr::from_ptr(text) }.to_string_lossy().into_owned()
}
