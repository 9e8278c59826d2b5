# What a newcomer types: `make demo`, then `make test`.

.PHONY: demo test setup check msrv lint bench fuzz accuracy platforms
.DEFAULT_GOAL := demo

# Builds, checks the course's shaders and says where the pictures are.
demo: setup
	cargo build --release
	./target/release/toyproof check glsl --out out

# Also counts the tests that were skipped for want of a driver or a program.
test:
	tests/run.sh

# Types, borrows and warnings of all crates, tests and benchmarks, without building them.
check:
	cargo check --workspace --all-targets

# The minimum supported version of Rust, in a folder of its own, since the artifacts of two versions replace each other.
msrv:
	CARGO_TARGET_DIR=$${CARGO_TARGET_DIR:-target}/msrv cargo +1.89 check --workspace --all-targets --locked

lint:
	cargo fmt --all --check
	cargo clippy --workspace --all-targets -- -D warnings

# Mesa's lavapipe, on which the shaders run; see `toyproof doctor`.
setup:
	@./setup.sh

bench:
	XDG_RUNTIME_DIR=$${XDG_RUNTIME_DIR:-/tmp} cargo bench

# Writes docs/evidence/accuracy/ and the parts of docs/evidence/accuracy.md that are measured anew.
accuracy:
	cargo build --release
	sh docs/evidence/accuracy/regenerate.sh ./target/release/toyproof

# Until it finds something or is stopped; needs a nightly compiler and cargo-fuzz. The code is safe Rust: no sanitizer.
fuzz:
	mkdir -p fuzz/corpus/front_end
	cargo +nightly fuzz run -s none front_end fuzz/corpus/front_end fuzz/seeds fuzz/regressions glsl -- \
		-dict=fuzz/glsl.dict -max_len=4096 -timeout=60

# Windows under wine, aarch64 under qemu, type checks for macOS and WebAssembly.
platforms:
	tests/platforms.sh
