# What a newcomer types: `make demo`, then `make test`.

.PHONY: demo test setup check lint bench fuzz accuracy platforms
.DEFAULT_GOAL := demo

# Builds, checks the course's shaders and says where the pictures are.
demo: setup
	cargo build --release
	./target/release/toyproof check glsl --out out

test:
	cargo test --workspace

# Types, borrows and warnings of all crates, tests and benchmarks, without building them.
check:
	cargo check --workspace --all-targets

lint:
	cargo fmt --all --check
	cargo clippy --workspace --all-targets -- -D warnings

# Mesa's lavapipe, on which the shaders run; see `toyproof doctor`.
setup:
	@./setup.sh

bench:
	XDG_RUNTIME_DIR=$${XDG_RUNTIME_DIR:-/tmp} cargo bench

# Writes docs/accuracy/ and the parts of docs/accuracy.md that are measured anew.
accuracy:
	cargo build --release
	sh docs/accuracy/regenerate.sh ./target/release/toyproof

# Until it finds something or is stopped; needs a nightly compiler and cargo-fuzz. The code is safe Rust: no sanitizer.
fuzz:
	mkdir -p fuzz/corpus/front_end
	cargo +nightly fuzz run -s none front_end fuzz/corpus/front_end fuzz/seeds fuzz/regressions glsl -- \
		-dict=fuzz/glsl.dict -max_len=4096 -timeout=60

# Windows under wine, aarch64 under qemu, type checks for macOS and WebAssembly.
platforms:
	tests/platforms.sh
