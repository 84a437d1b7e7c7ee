//! The feature `tracy`, by the profiler's own protocol: `cargo test --release --features tracy --test tracy`.
//!
//! The test takes the profiler's place: it connects, greets, and reads all that the program sends. The protocol is that
//! of Tracy 0.13 (`TracyProtocol.hpp`): a shibboleth and a version; one byte of status; a fixed welcome; then blocks, each
//! a length and LZ4, whose matches reach back into the blocks before.

use std::io::{ErrorKind, Read, Write};
use std::net::{Ipv6Addr, TcpListener, TcpStream};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

const VERSION: u32 = 82;
const WELCOME: u8 = 1;
/// Bytes of the welcome, and where in it the program's name is.
const WELCOME_BYTES: usize = 1170;
const NAME: std::ops::Range<usize> = 82..146;

/// The program, ended when the test does.
struct Program(Child);

impl Drop for Program {
    fn drop(&mut self) {
        let _ended = self.0.kill();
        let _waited = self.0.wait();
    }
}

fn connect(port: u16) -> TcpStream {
    let begin = Instant::now();
    loop {
        match TcpStream::connect((Ipv6Addr::LOCALHOST, port)) {
            Ok(stream) => return stream,
            Err(error) if begin.elapsed() > Duration::from_secs(20) => panic!("nobody listens: {error}"),
            Err(_) => sleep(Duration::from_millis(20)),
        }
    }
}

/// Appends what an LZ4 block holds to `out`.
fn decompress(block: &[u8], out: &mut Vec<u8>) {
    let mut bytes = block.iter().copied();
    let mut next = || bytes.next().map(usize::from);
    let length = |start: usize, next: &mut dyn FnMut() -> Option<usize>| {
        let mut length = start;
        let mut more = start == 15;
        while more {
            let byte = next().expect("a length");
            length += byte;
            more = byte == 255;
        }
        length
    };
    while let Some(token) = next() {
        for _ in 0..length(token >> 4, &mut next) {
            out.push(next().expect("a literal") as u8);
        }
        let Some(low) = next() else { break };
        let back = low + 256 * next().expect("a distance");
        for _ in 0..length(token & 15, &mut next) + 4 {
            out.push(out[out.len() - back]);
        }
    }
}

/// All that is sent until the program has no more to say.
fn receive(stream: &mut TcpStream) -> Vec<u8> {
    let mut sent = Vec::new();
    loop {
        let mut length = [0; 4];
        match stream.read_exact(&mut length) {
            Ok(()) => {}
            Err(error)
                if matches!(
                    error.kind(),
                    ErrorKind::WouldBlock | ErrorKind::TimedOut | ErrorKind::UnexpectedEof
                ) =>
            {
                return sent;
            }
            Err(error) => panic!("{error}"),
        }
        let mut block = vec![0; u32::from_le_bytes(length) as usize];
        stream.read_exact(&mut block).expect("a whole block");
        decompress(&block, &mut sent);
    }
}

#[test]
fn the_profiler_gets_zones_plots_and_frames() {
    // A port that was free a moment ago.
    let port =
        TcpListener::bind((Ipv6Addr::LOCALHOST, 0)).and_then(|l| l.local_addr()).expect("a port").port();
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let program = Command::new(env!("CARGO_BIN_EXE_voxgi"))
        .args(["profile", "-p", "mip_chain", "--size", "8x8", "--frames", "3"])
        .arg("--library")
        .args([root.join("tests/library-engine"), root.join("scenes/cornell-box.glb")])
        .envs([("TRACY_NO_EXIT", "1"), ("TRACY_ONLY_LOCALHOST", "1"), ("TRACY_PORT", &port.to_string())])
        .stdout(Stdio::null())
        .spawn();
    let _program = Program(program.expect("the program"));
    let mut stream = connect(port);
    stream.set_read_timeout(Some(Duration::from_secs(10))).expect("a timeout");
    stream.write_all(&[b"TracyPrf".as_slice(), &VERSION.to_le_bytes()].concat()).expect("a greeting");
    let mut status = [0];
    stream.read_exact(&mut status).expect("a status");
    assert_eq!(status[0], WELCOME);
    let mut welcome = [0; WELCOME_BYTES];
    stream.read_exact(&mut welcome).expect("a welcome");
    assert!(welcome[NAME].starts_with(b"voxgi"), "{:?}", String::from_utf8_lossy(&welcome[NAME]));

    let sent = receive(&mut stream);
    let count = |text: &str| sent.windows(text.len()).filter(|window| *window == text.as_bytes()).count();
    // Each zone's source location has the stage's path as function and as name: in 1 + 2 + 3 frames.
    for stage in ["position", "mean[0]", "mean[2]"] {
        assert_eq!(count(&format!("{stage}\0pipeline\0{stage}")), 6, "{stage}");
    }
    assert_eq!(count("\u{6}stages"), 1, "the name of the GPU's context, with its length");
    assert_eq!(count("no-such-stage"), 0);
}

/// `abcabcabcabc` and `!`, by hand: three literals, then nine bytes from three back; one literal.
#[test]
fn lz4_is_read_right() {
    let mut out = b"before ".to_vec();
    decompress(&[0x35, b'a', b'b', b'c', 3, 0, 0x10, b'!'], &mut out);
    assert_eq!(out, b"before abcabcabcabc!");
}
