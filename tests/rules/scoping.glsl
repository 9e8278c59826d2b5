// Names and what they mean where: §4.2.

//# 4.2.2 holds a local variable hides a global one
float x = 1.0;
bool holds() { float x = 2.0; return x == iTime; }

//# 4.2.2 holds a global variable is seen again after what hid it
float x = 1.0;
bool holds() { { float x = 2.0; x++; } return x == 1.0; }

//# 4.2.2 holds the value of a variable is read before its name is known
int x = 1;
bool holds() { int x = x + 1; return x == 2; }

//# 4.2.2 holds a name is known right after its declarator
bool holds() { int x = 1, y = x + 1, z = y + x; return z == 3; }

//# 4.2.2 E0200 a variable does not know itself
void f() {
    float a = a;  //!
}

//# 4.2.2 E0200 a name is unknown before its declaration
void f() {
    a = 1.0;  //!
    float a;
}

//# 4.2.2 E0200 a global name is unknown before its declaration
float f() {
    return later;  //!
}
float later;

//# 4.2.2 E0200 a function is unknown before its declaration
float f() {
    return later();  //!
}
float later() { return 1.0; }

//# 4.2.2 holds a prototype makes a function known
float later();
bool holds() { return later() == iTime; }
float later() { return 2.0; }

//# 4.2.2 E0200 a name ends with its block
void f() {
    { float a; }
    a = 1.0;  //!
}

//# 4.2.2 E0200 a local name ends with its function
void f() { float a; }
void g() {
    a = 1.0;  //!
}

//# 4.2.2 E0200 a parameter ends with its function
void f(float a) { }
void g() {
    a = 1.0;  //!
}

//# 4.2.2 E0200 what a for declares ends with it
void f() {
    for (int i = 0; i < 2; i++) { }
    i = 0;  //!
}

//# 4.2.2 E0200 what a while declares ends with it
void f() {
    while (bool again = false) { }
    again = true;  //!
}

//# 4.2.2 E0200 what a guarded statement declares ends with it
void f() {
    if (true) float a = 1.0;
    a = 2.0;  //!
}

//# 4.2.2 holds a guarded statement has a scope of its own
int a = 1;
bool holds() { if (iTime > 1.0) int a = 5; else int a = 6; return a == 1; }

//# 4.2.2 E0200 what the body of a do declares is unknown to its condition
void f() {
    do {
        bool again = false;
    } while (again);  //!
}

//# 4.2.2 E0200 what a switch declares ends with it
void f(int n) {
    switch (n) { case 0: int a = 1; }
    a = 2;  //!
}

//# 4.2.2 holds the cases of a switch share one scope
bool holds() { int r = 0; switch (iFrame) { case 0: int a; case 3: a = 4; r = a; } return r == 4; }

//# 4.2.2 E0201 the cases of a switch share one scope, so a name once
void f(int n) {
    switch (n) {
        case 0: int a = 1; break;
        case 1: int a = 2; break;  //!
    }
}

//# 4.2.2 holds what a while declares is made anew each time
bool holds() { int n = 0; while (bool again = n < 3) n++; return n == 3; }

//# 4.2.2 holds a for sees an outer name until it hides it
bool holds() { int i = 7, n = 0; for (int i = 0; i < 3; i++) n += i; return n == 3 && i == 7; }

//# 4.2.2 holds the parameters of two functions may have one name
float f(float a) { return a; }
float g(float a) { return a + 1.0; }
bool holds() { return f(1.0) + g(1.0) == 3.0; }

//# 4.2.2 holds a block inside of a function may hide a parameter
float f(float a) { { float a = 5.0; a++; } return a; }
bool holds() { return f(1.0) == 1.0; }

//# 4.2.2 E0201 parameters and body share one scope
void f(float a) {
    float a;  //!
}

//# 4.2.2 E0201 two parameters have two names
// ANGLE names the line of the function.
void f(float a,
       int a) { }  //!

//# 4.2.2 E0201 a scope has a name once
void f() {
    float a;
    int a;  //!
}

//# 4.2.2 E0201 a declaration has a name once
float a, a;  //!

//# 4.2.2 E0201 the global scope has a name once
float a;
int b;
float a;  //!

//# 4.2.2 E0201 a for and its body share one scope
// glslang gives the body a scope of its own.
void f() {
    for (int i = 0; i < 2; i++) {
        int i = 1;  //!
    }
}

//# 4.2.2 E0201 a while and its body share one scope
// glslang gives the body a scope of its own.
void f() {
    while (bool a = false) {
        bool a = true;  //!
    }
}

//# 4.2.2 holds a block in the body of a for may hide what the for declares
bool holds() { int n = 0; for (int i = 0; i < 2; i++) { { int i = 10; n += i; } } return n == 20; }

//# 4.2.2 E0201 a variable is not a function
float f;
float f() { return 1.0; }  //!

//# 4.2.2 E0201 a function is not a variable
float f() { return 1.0; }
float f;  //!

//# 4.2.2 E0201 a structure is not a variable
struct S { float a; };
float S;  //!

//# 4.2.2 E0201 a structure has its constructor's name already
struct S { float a; };
S S(float a, float b) { return S(a + b); }  //!

//# 4.2.2 E0201 a structure is declared once
struct S { float a; };
struct S { float a; };  //!

//# 4.2.2 holds a local variable hides a function
float f() { return 1.0; }
bool holds() { float x = f(); float f = 2.0; return x + f == 3.0; }

//# 4.2.2 E0202 a hidden function cannot be called
float f() { return 1.0; }
void g() {
    float f = 2.0;
    f();  //!
}

//# 4.2.2 holds a local variable hides a structure
struct S { float a; };
bool holds() { S s = S(1.0); float S = 2.0; return s.a + S == 3.0; }

//# 4.2.2 error a hidden structure is not a type
struct S { float a; };
void f() {
    float S = 1.0;
    S s;  //!
}

//# 4.2.2 holds a local structure hides a global one
struct S { float a; };
bool holds() { struct S { int b, c; }; S s = S(1, 2); return s.b + s.c == 3; }

//# 4.2.2 error a local structure ends with its function
void f() { struct S { float a; }; }
void g() {
    S s;  //!
}

//# 4.2.2 holds members have names of their own
struct S { float a; };
float a = 1.0;
bool holds() { S s; s.a = 2.0; return a + s.a == 3.0; }

//# 4.2.2 holds structures do not share the names of their members
struct S { float a; };
struct T { int a; };
bool holds() { return S(1.0).a + float(T(2).a) == 3.0; }

//# 4.2.2 holds a local variable may be called as a built-in function
bool holds() { float sin = 2.0; return sin + cos(0.0) == 3.0; }

//# 4.2.2 holds a parameter may be called as a built-in function
float f(float dot, float step) { return dot + step; }
bool holds() { return f(1.0, 2.0) == 3.0; }

//# 4.2.2 E0202 a hidden built-in function cannot be called
void f() {
    float sin = 1.0;
    sin(1.0);  //!
}

//# 4.2.2 E0201 a built-in function cannot be redefined
float sin(float x) { return x; }  //!

//# 4.2.2 E0201 a built-in function cannot be overloaded
vec2 sin(int x) { return vec2(x); }  //!

//# 4.2.2 E0201 a built-in function's prototype cannot be repeated
float sin(float x);  //!

//# 4.2.2 holds a global variable may be called as a built-in function, and hides it
// glslang does not let it.
float distance = 1.0;
bool holds() { return distance + length(vec2(3.0, 4.0)) == 6.0; }

//# 4.2.2 E0202 what a global variable hides cannot be called
float distance = 1.0;
float f() {
    return distance(1.0, 2.0);  //!
}

//# 4.2.2 holds a structure may be called as a built-in function, and hides it
// glslang does not let it.
struct reflect { float a; };
bool holds() { reflect r = reflect(2.0); return r.a == iTime; }

//# 4.2.2 holds a local variable may be called as its type's structure
struct ray { float a; };
bool holds() { ray ray = ray(2.0); return ray.a == iTime; }

//# 4.2.2 holds members may be called as functions and types
struct S { float sin, S, holds; };
bool holds() { S s = S(1.0, 2.0, 3.0); return s.sin + s.S + s.holds == 6.0; }

//# 4.2.2 holds a function may have a parameter called as itself
float f(float f) { return f + 1.0; }
bool holds() { return f(1.0) == 2.0; }

//# 4.2.2 holds the size of an array sees the constant that its function hides later
const int n = 2;
bool holds() { float a[n]; const int n = 3; float b[n]; return a.length() + b.length() == 5; }

//# 4.2.2 E0202 a function is not a value
float f() { return 1.0; }
void g() {
    float x = f;  //!
}

//# 4.2.2 E0100 a structure is not a value
struct S { float a; };
void g() {
    float x = S + 1.0;  //!
}

//# 4.2.2 E0202 a variable cannot be called
void f(float a) {
    a(1.0);  //!
}

//# 4.2.2 E0202 a built-in function is not a value
void f() {
    float x = sin;  //!
}
