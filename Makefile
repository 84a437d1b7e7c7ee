# Both commands are complete on a bare Debian or Ubuntu with Rust, with or without a GPU; scripts/setup.sh says what they
# install and when.
#
#   make demo    build, compare pipelines on the built-in scenes, say where the report is
#   make test    formatting, lints as errors, all tests

# rustup's folder, for shells that have not read its profile yet.
export PATH := $(PATH):$(or $(CARGO_HOME),$(HOME)/.cargo)/bin

.PHONY: demo test
.NOTPARALLEL:

demo:
	sh scripts/setup.sh
	cargo build --release --locked
	sh scripts/demo.sh "$(or $(CARGO_TARGET_DIR),target)/release/voxgi"

test:
	sh scripts/setup.sh --lints
	sh tests/setup/run.sh
	cargo fmt --check
	cargo clippy --locked --all-targets -- -D warnings
	cargo test --locked --release
