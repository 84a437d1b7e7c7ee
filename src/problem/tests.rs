use super::Problem;

/// Whatever is quoted, a message can be read, and no character is cut.
#[test]
fn long_messages_lose_their_middle() {
    for letter in ["a", "é", "→", "🦀"] {
        let text = format!("begin {} end", letter.repeat(50_000));
        let problem = Problem::input("code", text.clone()).help(text);
        for found in [Some(problem.message), problem.help].into_iter().flatten() {
            assert!(found.len() < 4000 && found.starts_with("begin ") && found.ends_with(" end"), "{letter}");
        }
    }
    assert_eq!(Problem::input("code", "short").message, "short");
}
