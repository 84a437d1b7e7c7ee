//! Zones: what the CPU is doing, for the Tracy profiler. Without the feature `tracy` they are nothing at all.

/// A zone of this name (a literal) until the value is dropped.
macro_rules! zone {
    ($name:literal) => {
        $crate::zone::Zone {
            #[cfg(feature = "tracy")]
            _span: tracy_client::Client::running()
                .map(|client| client.span(tracy_client::span_location!($name), 0)),
        }
    };
}
pub(crate) use zone;

/// See [`zone!`].
pub(crate) struct Zone {
    #[cfg(feature = "tracy")]
    pub _span: Option<tracy_client::Span>,
}

// So that ending a zone early is a drop that does something, with and without the feature.
impl Drop for Zone {
    fn drop(&mut self) {}
}
