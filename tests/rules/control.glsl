// Selection, iteration and jumps: §6.2 to §6.4.

//# 6.2 holds if takes the branch of its condition
bool holds() { int n = 0; if (iTime > 1.0) n += 1; if (iTime < 1.0) n += 10; else n += 100; return n == 101; }

//# 6.2 holds an else belongs to the nearest if
bool holds() { int n = 0; if (iTime > 1.0) if (iTime > 5.0) n = 1; else n = 2; return n == 2; }

//# 6.2 holds an else if is an if
bool holds() { int n; if (iFrame == 1) n = 1; else if (iFrame == 2) n = 2; else if (iFrame == 3) n = 3; else n = 4; return n == 3; }

//# 6.2 holds a branch may be empty
bool holds() { if (iTime < 1.0) ; else { } if (iTime > 1.0) { } return true; }

//# 6.2 holds a condition may be an assignment
bool holds() { bool b; if (b = iTime > 1.0) return b; return false; }

//# 6.2 holds a switch goes to the label of its value
bool holds() { int n = 0; switch (iFrame) { case 1: n = 10; break; case 3: n = 30; break; default: n = 99; } return n == 30; }

//# 6.2 holds a switch goes to default where no label fits
bool holds() { int n = 0; switch (iFrame) { case 1: n = 10; break; default: n = 99; break; case 2: n = 20; } return n == 99; }

//# 6.2 holds a switch without fitting label does nothing
bool holds() { int n = 1; switch (iFrame) { case 1: n = 10; break; } return n == 1; }

//# 6.2 holds a switch falls through
bool holds() { int n = 0; switch (iFrame) { case 2: n += 1; case 3: n += 10; case 4: n += 100; break; case 5: n += 1000; } return n == 110; }

//# 6.2 holds a switch falls through default in the middle
bool holds() { int n = 0; switch (iFrame) { case 1: n += 1; default: n += 10; case 2: n += 100; } return n == 110; }

//# 6.2 holds several labels share one branch
bool holds() { int n = 0; switch (iFrame) { case 1: case 3: case 5: n = 1; break; case 2: default: n = 2; } return n == 1; }

//# 6.2 holds a switch may be by uint
bool holds() { switch (uint(iFrame)) { case 3u: return true; default: return false; } return false; }

//# 6.2 holds labels may be negative
bool holds() { switch (iFrame - 5) { case -2: return true; } return false; }

//# 6.2 holds switches nest, and break leaves the inner one
bool holds() { int n = 0; switch (iFrame) { case 3: switch (iFrame) { case 3: n += 1; break; default: n += 10; } n += 100; break; default: n += 1000; } return n == 101; }

//# 6.2 holds a break is allowed anywhere in a switch
bool holds() { int n = 0; switch (iFrame) { case 3: if (iTime > 1.0) break; n = 1; default: n += 2; } return n == 0; }

//# 6.2 holds a switch may be empty
bool holds() { int n = 0; switch (n++) { } return n == 1; }

//# 6.2 holds what a switch is by is evaluated once
int n = 0;
int next() { return ++n; }
bool holds() { int r = 0; switch (next()) { case 2: r = 2; break; case 1: r = 1; break; } return r == 1 && n == 1; }

//# 6.2 holds a switch in a loop may continue it
bool holds() { int n = 0; for (int i = 0; i < 5; i++) { switch (i) { case 1: case 2: continue; case 4: break; default: n += 100; } n += 1; } return n == 203; }

//# 6.3 holds a for runs while its condition holds
bool holds() { int n = 0; for (int i = 0; i < 5; i++) n += i; return n == 10; }

//# 6.3 holds a for may lack everything
bool holds() { int i = 0; for (;;) { if (i == 4) break; i++; } return i == 4; }

//# 6.3 holds a for may begin with an expression
bool holds() { int i, n = 0; for (i = 2, n = 1; i < 4; ++i, n *= 2) ; return i == 4 && n == 4; }

//# 6.3 holds a for may declare several variables
bool holds() { int n = 0; for (int i = 0, j = 10; i < j; i++, j--) n++; return n == 5; }

//# 6.3 holds a for may count floats
bool holds() { float s = 0.0; for (float x = 0.0; x < 1.0; x += 0.25) s += x; return s == 1.5; }

//# 6.3 holds the condition of a for may declare
bool holds() { int n = 0; for (int i = 0; bool more = i < 3; i++) if (more) n++; return n == 3; }

//# 6.3 holds continue goes to the step of a for
bool holds() { int n = 0; for (int i = 0; i < 6; i++) { if (i % 2 == 0) continue; n += i; } return n == 9; }

//# 6.3 holds break leaves the inner loop only
bool holds() { int n = 0; for (int i = 0; i < 3; i++) for (int j = 0; j < 9; j++) { if (j > i) break; n++; } return n == 6; }

//# 6.3 holds a while loop tests before its body
bool holds() { int n = 0; while (n < iFrame) n++; while (n < 0) n = 99; return n == 3; }

//# 6.3 holds a do loop tests after its body
bool holds() { int n = 0; do n++; while (n < 0); return n == 1; }

//# 6.3 holds continue in a do goes to its condition
bool holds() { int n = 0, m = 0; do { n++; if (n == 2) continue; m += n; } while (n < 4); return n == 4 && m == 8; }

//# 6.3 holds continue in a while goes to its condition
bool holds() { int n = 0, m = 0; while (n < 5) { n++; if (n == 3) continue; m += n; } return m == 12; }

//# 6.3 holds the body of a loop may change what it counts by
bool holds() { int n = 0; for (int i = 0; i < 10; i++) { i += 2; n++; } return n == 4; }

//# 6.3 holds a variable of the body is new each time
bool holds() { int n = 0; for (int i = 0; i < 3; i++) { int a = 0; a++; n += a; } return n == 3; }

//# 6.4 holds return leaves all loops
int f() { for (int i = 0; i < 9; i++) for (int j = 0; j < 9; j++) if (i * j == 6) return i * 10 + j; return -1; }
bool holds() { return f() == 16; }

//# 6.4 holds what follows a jump is never reached
bool holds() { int n = 0; for (int i = 0; i < 3; i++) { n++; continue; n += 100; } return n == 3; }

//# 6.4 holds discard where it is not reached does nothing
bool holds() { if (iTime < 1.0) discard; return true; }

//# 6.2 E0301 a condition is a bool: int
void f(int n) {
    if (n) { }  //!
}

//# 6.2 E0301 a condition is a bool: float
void f(float a) {
    if (a) { }  //!
}

//# 6.2 E0301 a condition is one bool
void f(bvec2 b) {
    if (b) { }  //!
}

//# 6.2 E0301 a condition cannot be the assignment of a number
void f(int n) {
    if (n = 1) { }  //!
}

//# 6.2 E0100 an if has its condition in parentheses
void f(bool b) {
    if b { }  //!
}

//# 6.2 E0100 an if has a condition
void f() {
    if () { }  //!
}

//# 6.2 E0100 the condition of an if declares nothing
void f() {
    if (bool b = true) { }  //!
}

//# 6.2 E0100 an else has its if
void f() {
    else { }  //!
}

//# 6.2 E0100 an if has one else
void f(bool b) {
    if (b) { } else { } else { }  //!
}

//# 6.2 error then is not a keyword
void f(bool b) {
    if (b) then { }  //!
}

//# 6.2 E0407 a switch is by an integer: float
void f(float a) {
    switch (a) { default: break; }  //!
}

//# 6.2 E0407 a switch is by an integer: bool
void f(bool a) {
    switch (a) { default: break; }  //!
}

//# 6.2 E0407 a switch is by one integer
void f(ivec2 a) {
    switch (a) { default: break; }  //!
}

//# 6.2 E0301 a label has the type of its switch
// glslang converts it.
void f(int n) {
    switch (n) {
        case 1u: break;  //!
    }
}

//# 6.2 error a label is an integer
void f(int n) {
    switch (n) {
        case 1.0: break;  //!
    }
}

//# 6.2 E0407 no two labels are equal
void f(int n) {
    switch (n) {
        case 1: break;
        case 1: break;  //!
    }
}

//# 6.2 E0407 no two labels are equal, however they are written
const int two = 2;
void f(int n) {
    switch (n) {
        case two: break;
        case 1 + 1: break;  //!
    }
}

//# 6.2 E0407 there is one default
void f(int n) {
    switch (n) {
        default: break;
        default: break;  //!
    }
}

//# 6.2 E0407 a switch begins with a label
void f(int n) {
    switch (n) {
        n++;  //!
        case 1: break;
    }
}

//# 6.2 E0407 a declaration cannot precede the first label
// glslang lets it.
void f(int n) {
    switch (n) {
        int a;  //!
        case 1: break;
    }
}

//# 6.2 E0407 something follows the last label
// ANGLE names the line of the switch.
void f(int n) {
    switch (n) {
        case 1:
    }  //!
}

//# 6.2 E0407 a label cannot be inside a block of its switch
void f(int n) {
    switch (n) {
        case 1: {
            case 2: break;  //!
        }
    }
}

//# 6.2 E0407 a label cannot be outside a switch
void f() {
    case 1: ;  //!
}

//# 6.2 E0407 a default cannot be outside a switch
void f() {
    default: ;  //!
}

//# 6.2 E0100 a label ends with a colon
void f(int n) {
    switch (n) {
        case 1 break;  //!
    }
}

//# 6.2 E0100 a case has a value
void f(int n) {
    switch (n) {
        case : break;  //!
    }
}

//# 6.2 E0100 a switch has braces
void f(int n) {
    switch (n) case 1: break;  //!
}

//# 6.3 E0301 the condition of a for is a bool
void f() {
    for (int i = 3; i; i--) { }  //!
}

//# 6.3 E0301 the condition of a while is a bool
void f(int n) {
    while (n) n--;  //!
}

//# 6.3 E0301 the condition of a do is a bool
void f(int n) {
    do n--; while (n);  //!
}

//# 6.3 E0301 what a condition declares is a bool
void f() {
    while (int i = 1) { }  //!
}

//# 6.3 E0100 a for has two semicolons
void f() {
    for (int i = 0; i < 2) { }  //!
}

//# 6.3 E0100 a for has no more than two semicolons
void f() {
    for (int i = 0; i < 2; i++;) { }  //!
}

//# 6.3 error the parts of a for are not parted by commas
void f() {
    for (int i = 0, i < 2, i++) { }  //!
}

//# 6.3 E0100 a while has a condition
void f() {
    while () { }  //!
}

//# 6.3 E0100 a do has a while
void f() {
    do { }
}  //!

//# 6.3 E0100 a do ends with a semicolon
void f(int n) {
    do { n++; } while (n < 2)  //!
}

//# 6.3 E0100 what a condition declares has a value
void f() {
    while (bool b) { }  //!
}

//# 6.3 E0100 the condition of a do declares nothing
void f() {
    do { } while (bool b = false);  //!
}

//# 6.3 E0100 the step of a for declares nothing
void f() {
    for (int i = 0; i < 2; int j = 1) { }  //!
}

//# 6.3 E0100 foreach is not supported
void f(float a[2]) {
    for (float x : a) { }  //!
}

//# 6.4 E0408 break leaves a loop or switch
void f() {
    break;  //!
}

//# 6.4 E0408 continue goes on with a loop
void f() {
    continue;  //!
}

//# 6.4 E0408 break does not leave an if
void f(bool b) {
    if (b) { break; }  //!
}

//# 6.4 E0408 continue does not go on with a switch
void f(int n) {
    switch (n) {
        case 1: continue;  //!
    }
}

//# 6.4 E0408 break does not leave a loop of the caller
void g() {
    break;  //!
}
void f() { for (;;) { g(); break; } }

//# 6.4 E0408 continue comes too late after its loop
void f() {
    for (int i = 0; i < 2; i++) { }
    continue;  //!
}

//# 6.4 E0100 break has no number
void f() {
    for (;;) { break 2; }  //!
}

//# 6.4 E0100 discard returns nothing
void f() {
    discard 1.0;  //!
}

//# 6.4 E0100 a statement ends with a semicolon
void f() {
    float a = 1.0  //!
    a = 2.0;
}

//# 6.4 E0100 return ends with a semicolon
float f() {
    return 1.0  //!
}

//# 6.4 E0100 a statement cannot be outside a function
float a;
a = 1.0;  //!

//# 6.4 E0100 a loop cannot be outside a function
for (int i = 0; i < 2; i++) { }  //!

//# 6.4 E0105 a brace too many ends nothing
void f() { }
}  //!

//# 6.1 error a lone semicolon cannot be outside a function
// glslang lets it.
void f() { };  //!
