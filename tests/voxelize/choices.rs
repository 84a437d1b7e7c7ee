//! Parts that don't go together are refused with the reason and the way out.

use voxgi::library::Library;
use voxgi::session::{Request, prepare};

/// Light needs to know of surfaces, and bits know nothing but where something is.
#[test]
fn light_needs_a_payload_with_attributes() {
    let library = Library::new(Vec::new()).expect("the library");
    let with = |payload: &str| {
        let parts = vec![("payload".to_owned(), payload.to_owned())];
        prepare(&Request { pipeline: "cones".to_owned(), parts, ..Request::default() }, &library, None)
    };
    for payload in ["payload/bits", "payload/slices"] {
        let problems = with(payload).expect_err("it has no attributes");
        let found: Vec<_> = problems.iter().collect();
        assert!(found.iter().all(|problem| problem.code == "part-lacks"), "{found:?}");
        let said = |name: &str| found.iter().any(|problem| problem.message.contains(name));
        assert!(said(payload) && said("surfel_of") && said("emission_of"), "{found:?}");
        for problem in found {
            let help = problem.help.as_deref().unwrap_or_default();
            let choice = help.lines().next().unwrap_or_default();
            assert!(choice.contains("--part payload=") && !choice.contains(payload), "{help}");
            let named: Vec<&str> = choice.split('`').filter(|name| name.starts_with("payload/")).collect();
            assert!(named.contains(&"payload/sums") && named.contains(&"payload/compact"), "{help}");
            for other in named {
                assert!(with(other).is_ok(), "{other} is a way out");
            }
        }
    }
}
