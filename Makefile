# What a newcomer types: `make demo`, then `make test`.

.PHONY: demo test setup bench fuzz accuracy
.DEFAULT_GOAL := demo

# Builds, checks the course's shaders and says where the pictures are.
demo: setup
	cargo build --release
	./target/release/toyproof check glsl --out out

test:
	cargo test --workspace

# Mesa's lavapipe, on which the shaders run; see `toyproof doctor`.
setup:
	@./setup.sh

bench:
	XDG_RUNTIME_DIR=$${XDG_RUNTIME_DIR:-/tmp} cargo bench

# Writes docs/accuracy/ and the parts of docs/accuracy.md that are measured anew.
accuracy:
	cargo build --release
	sh docs/accuracy/regenerate.sh ./target/release/toyproof

# Until it finds something or is stopped; needs a nightly compiler and cargo-fuzz. The code is safe Rust: no sanitiser.
fuzz:
	mkdir -p fuzz/corpus/front_end
	cargo +nightly fuzz run -s none front_end fuzz/corpus/front_end fuzz/seeds fuzz/regressions glsl -- \
		-dict=fuzz/glsl.dict -max_len=4096 -timeout=60
