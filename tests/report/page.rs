//! The page as text.

use crate::fixture;
use std::path::Path;
use voxgi::comparison::Comparison;
use voxgi::report::html;

fn made(command: &str) -> (tempfile::TempDir, Comparison) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let comparison = fixture::write(folder.path(), command);
    (folder, comparison)
}

fn page(comparison: &Comparison, folder: &Path) -> String {
    html(comparison, folder).expect("a page")
}

/// What follows each `before`, up to `after`.
fn values<'a>(page: &'a str, before: &str, after: char) -> Vec<&'a str> {
    page.split(before).skip(1).filter_map(|rest| rest.split(after).next()).collect()
}

#[test]
fn nothing_is_loaded() {
    for command in ["compare", "sweep"] {
        let (folder, comparison) = made(command);
        let page = page(&comparison, folder.path());
        let sources = values(&page, " src=\"", '"');
        assert!(sources.len() > 100, "{} pictures", sources.len());
        assert!(sources.iter().all(|source| source.starts_with("data:image/png;base64,")));
        assert!(values(&page, "url(", ')').iter().all(|url| url.starts_with("data:image/png;base64,")));
        let links = values(&page, " href=\"", '"');
        assert!(links.iter().all(|link| link.starts_with('#') || link.starts_with("./")), "{links:?}");
        for element in ["<link", "<iframe", "<object", "<embed", "<base", "@import", "srcset", " action="] {
            assert!(!page.contains(element), "{element}");
        }
        assert!(page.contains("default-src 'none'"));
    }
}

#[test]
fn links_lead_somewhere() {
    let (folder, comparison) = made("compare");
    let page = page(&comparison, folder.path());
    let anchors = values(&page, " id=\"", '"');
    let links = values(&page, " href=\"#", '"');
    assert!(links.len() > 100);
    for link in links {
        assert_eq!(anchors.iter().filter(|anchor| **anchor == link).count(), 1, "{link}");
    }
    assert!(page.contains("href=\"./comparison.json\""));
}

#[test]
fn everything_that_was_said_is_there() {
    let (folder, comparison) = made("compare");
    let page = page(&comparison, folder.path());
    let words = [
        "llvmpipe (LLVM 15.0.6, 256 bits)",
        "Mesa 25.0.7",
        "timestamps",
        "exposure +0.5 stops, tone curve reinhard",
        "262\u{202f}267",
        "within the reference's noise",
        "2 transmissive materials are rendered opaque (in all runs)",
        "glossy surfaces are rendered matt (in 4, 5)",
        "scene.moving is false",
        "it depends on geometry, and that did not change",
        "alpha resolution=128 gather=gather/many",
        "Ratio of means",
    ];
    for word in words {
        assert!(page.contains(word), "{word}");
    }
    // Only sweeps have curves.
    assert!(!page.contains("What each step costs and gives"));
}

/// Without scripts nothing takes `hidden` away.
#[test]
fn one_output_and_one_measure_are_shown_at_first() {
    let (folder, comparison) = made("compare");
    let page = page(&comparison, folder.path());
    let choices = values(&page, "<div data-output=\"", '>');
    let shown: Vec<&&str> = choices.iter().filter(|choice| !choice.ends_with("hidden")).collect();
    assert!(shown.len() >= 2 && shown.iter().all(|choice| choice.starts_with("color\"")), "{shown:?}");
    let charts: Vec<&&&str> = shown.iter().filter(|choice| choice.contains("data-measure")).collect();
    assert_eq!(charts.len(), comparison.scenes.len());
    assert!(charts.iter().all(|choice| choice.contains("\"relmse\"")), "{charts:?}");
    assert_eq!(page.matches("class=\"run\"").count(), comparison.runs.len());
    assert!(!page.contains("class=\"run unchosen"));
}

#[test]
fn the_best_of_each_measure_is_bold() {
    let (folder, comparison) = made("compare");
    let page = page(&comparison, folder.path());
    // By hand: the errors of `gamma` are the least, and its SSIM and bias the nearest to 1.
    let bold = values(&page, "<strong>", '<');
    assert!(["0.00150", "0.00120", "0.0155", "0.999"].iter().all(|value| bold.contains(value)), "{bold:?}");
    assert!(!bold.contains(&"0.0900"));
}

#[test]
fn a_sweep_says_what_each_step_gives() {
    let (folder, comparison) = made("sweep");
    let page = page(&comparison, folder.path());
    // Times are 4 · size^1.6: twice the resolution takes 2^1.6 = 3.03 times as long.
    for words in ["32 → 64", "64 → 128", "gather/few → gather/many", "× 3.03", "× 2.50", "+ trace/second"]
    {
        assert!(page.contains(words), "{words}");
    }
}

#[test]
fn the_same_comparison_gives_the_same_bytes() {
    let (folder, comparison) = made("compare");
    assert!(page(&comparison, folder.path()) == page(&comparison, folder.path()));
    let (elsewhere, _) = made("compare");
    assert!(page(&comparison, folder.path()) == page(&comparison, elsewhere.path()));
}

#[test]
fn hostile_names_are_text() {
    let (folder, mut comparison) = made("sweep");
    let hostile = "</script><script>alert(1)</script>\"'><img src=x onerror=alert(2)>";
    comparison.name = hostile.to_owned();
    comparison.date = hostile.to_owned();
    comparison.adapter.name = hostile.to_owned();
    comparison.curve = hostile.to_owned();
    comparison.scenes[0].lacks = vec![hostile.to_owned()];
    comparison.scenes[0].name = hostile.to_owned();
    for (number, run) in comparison.runs.iter_mut().enumerate() {
        run.scene = hostile.to_owned();
        run.name = format!("{hostile}{number}");
        run.pipeline = hostile.to_owned();
        run.stages[0].path = hostile.to_owned();
        run.set.insert(hostile.to_owned(), format!("{hostile}{}", number % 2));
        let errors = run.errors.remove("color").expect("there are errors of color");
        run.errors.insert(hostile.to_owned(), errors);
        let mut pictures = run.pictures.remove("color").expect("there are pictures of color");
        pictures.exr = "javascript:alert(3)".to_owned();
        run.pictures.insert(hostile.to_owned(), pictures);
    }
    let page = page(&comparison, folder.path());
    assert_eq!(page.matches("<script").count(), 1);
    assert!(!page.contains("<img src=x") && !page.contains("\"javascript:"));
    assert!(page.contains("&lt;script&gt;alert(1)"));
}

#[test]
fn what_is_missing_is_said() {
    let (folder, comparison) = made("compare");
    let refusal = |comparison: &Comparison| {
        let problems = html(comparison, folder.path()).expect_err("no page can be made");
        let problem = problems.iter().next().expect("a problem").clone();
        assert_eq!((problem.code, problem.kind.exit_code()), ("report-picture", 2), "{}", problem.message);
        problem.message
    };
    let with = |path: &str| {
        let mut changed = comparison.clone();
        let pictures = changed.runs[1].pictures.get_mut("color").expect("there are pictures of color");
        pictures.png = path.to_owned();
        changed
    };
    let message = refusal(&with("lost.png"));
    assert!(
        message.contains("lost.png") && message.contains("`alpha resolution=128` on scene `cornell-box`"),
        "{message}"
    );
    assert!(refusal(&with("comparison.json")).contains("comparison.json"));
    for outside in ["../x.png", "/etc/passwd", ""] {
        assert!(refusal(&with(outside)).contains("out of the folder"));
    }
    let mut larger = comparison.clone();
    larger.size = [128, 96];
    assert!(refusal(&larger).contains("96×96 pixels, and the comparison is of 128×96"));
}

#[test]
fn little_is_enough() {
    let (folder, comparison) = made("compare");
    let mut bare = comparison.clone();
    for run in &mut bare.runs {
        run.gpu_ms = Default::default();
        run.pictures.clear();
        run.masked.clear();
        run.stages.clear();
    }
    bare.scenes[0].references.clear();
    assert!(page(&bare, folder.path()).contains("No run has both a time and relMSE of color."));
    bare.runs.clear();
    assert!(page(&bare, folder.path()).contains("There are no runs on this scene."));
    bare.scenes.clear();
    assert!(page(&bare, folder.path()).contains("0 runs on 0 scenes"));
}
