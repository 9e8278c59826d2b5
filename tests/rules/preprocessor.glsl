// The preprocessor: §3.4 and §3.5.

//# 3.4 holds an object-like macro expands to its tokens
#define TWO 1.0 + 1.0
bool holds() { return TWO * 3.0 == 4.0; }

//# 3.4 E0200 the name of a macro is unknown before its definition
float f() {
    return TWO;  //!
}
#define TWO 2.0

//# 3.4 holds a function macro takes arguments
#define SQUARE(x) ((x) * (x))
bool holds() { return SQUARE(iTime + 1.0) == 9.0; }

//# 3.4 holds arguments are tokens, not values
#define TWICE(x) x * 2
bool holds() { return TWICE(1 + 2) == 5; }

//# 3.4 E0008 a macro takes as many arguments as it has parameters: too few
#define ADD(a, b) (a + b)
float f() {
    return ADD(1.0);  //!
}

//# 3.4 E0008 a macro takes as many arguments as it has parameters: too many
#define SQUARE(x) ((x) * (x))
float f() {
    return SQUARE(1.0, 2.0);  //!
}

//# 3.4 holds parentheses keep the commas of an argument together
#define FIRST(x) x
bool holds() { return FIRST(max(1.0, iTime)) == 2.0; }

//# 3.4 E0008 an invocation of a macro ends with its parenthesis
#define SQUARE(x) ((x) * (x))
float f() {
    return SQUARE(1.0;  //!
}

//# 3.4 holds a function macro without parenthesis is a plain name
#define f(x) (x + 1.0)
float g(float f) { return f; }
bool holds() { return g(2.0) + f(1.0) == 4.0; }

//# 3.4 holds a blank before the parenthesis makes an object macro
#define VALUE (3.0)
bool holds() { return VALUE == 3.0; }

//# 3.4 holds a blank before the parenthesis of an invocation means nothing
#define SQUARE(x) ((x) * (x))
bool holds() { return SQUARE
    (3.0) == 9.0; }

//# 3.4 holds a function macro may have no parameters
#define NOW() iTime
bool holds() { return NOW() == 2.0; }

//# 3.4 holds an argument may be empty
// glslang wants something.
#define SIGN(s) (s 1.0)
bool holds() { return SIGN() == 1.0 && SIGN(-) == -1.0; }

//# 3.4 holds macros are expanded where they are used
#define A B
#define B 1.0
bool holds() {
    float x = A;
#undef B
#define B 2.0
    return x + A == 3.0;
}

//# 3.4 holds a macro is not expanded in itself
float x = 1.0;
#define x (x + 1.0)
bool holds() { return x == 2.0; }

//# 3.4 holds macros that name each other come to an end
float a = 1.0, b = 2.0;
#define a (b + 10.0)
#define b (a + 100.0)
bool holds() { return a == 111.0 && b == 112.0; }

//# 3.4 holds the result of an expansion may take the arguments that follow
#define SQUARE(x) ((x) * (x))
#define OP SQUARE
bool holds() { return OP(3.0) == 9.0; }

//# 3.4 holds a macro may open what another closes
#define BEGIN {
#define END }
bool holds() BEGIN return true; END

//# 3.4 E0100 a macro may leave something out
#define NOTHING
float f() {
    return 1.0 + NOTHING;  //!
}

//# 3.4 holds a macro may be empty
#define NOTHING
bool holds() { return NOTHING true NOTHING; }

//# 3.4 holds a macro may be defined again as it was
#define X 1.0 + iTime
#define X 1.0 + iTime
bool holds() { return X == 3.0; }

//# 3.4 E0007 a macro may not be defined again differently
#define X 1.0
#define X 2.0  //!

//# 3.4 E0007 a macro may not be defined again with other parameters
#define X(a) 1.0
#define X(b) 1.0  //!

//# 3.4 E0007 a macro may not be defined again with parameters
#define X 1.0
#define X() 1.0  //!

//# 3.4 holds a macro that was undefined may be defined anew
#define X 1.0
#undef X
#define X 2.0
bool holds() { return X == iTime; }

//# 3.4 holds a name that is not a macro may be undefined
#undef NEVER_DEFINED
bool holds() { return true; }

//# 3.4 E0200 an undefined macro is not expanded
#define X 1.0
#undef X
float f() {
    return X;  //!
}

//# 3.4 E0004 a macro has a name
#define  //!

//# 3.4 E0004 the name of a macro is a name
#define 2 3  //!

//# 3.4 E0004 a parameter of a macro is a name
#define F(1) 1  //!

//# 3.4 E0004 the parameters of a macro are parted by commas
#define F(a b) a  //!

//# 3.4 E0004 the parameters of a macro end
#define F(a, b  //!

//# 3.4 E0007 no two parameters of a macro have one name
#define F(a, a) a  //!

//# 3.4 E0007 names that begin with GL_ are not the author's to define
#define GL_toyproof 1  //!

//# 3.4 E0007 a predefined macro cannot be defined
#define __LINE__ 1  //!

//# 3.4 E0007 a predefined macro cannot be undefined
#undef GL_ES  //!

//# 3.4 E0007 the version cannot be defined
#define __VERSION__ 100  //!

//# 3.4 E0007 defined cannot be the name of a macro
#define defined 1  //!

//# 3.4 E0004 nothing follows the name after undef
#define X
#undef X 1  //!

//# 3.4 E0004 undef has a name
#undef  //!

//# 3.4 holds names with two underscores are reserved and work
#define a__b 2.0
bool holds() { return a__b == iTime; }

//# 3.4 holds keywords can be macros
#define float int
float n = 3;
bool holds() { return n / 2 == 1; }

//# 3.4 holds inner names of a macro are the user's scope's
#define X x
float x = 1.0;
bool holds() { float x = 2.0; return X == 2.0; }

//# 3.4 E0009 the operator # is not supported
#define S(x) #x
float f() {
    return S(1.0);  //!
}

//# 3.4 E0009 the operator ## is not supported
#define P(a, b) a ## b
float f() {
    return P(1, .0);  //!
}

//# 3.4 holds tokens do not grow together
#define MINUS -
bool holds() { int i = 3; return MINUS-i == 3 && i == 3; }

//# 3.4 holds the line and version are macros
int line = __LINE__;
bool holds() {
    return line == 1 && __LINE__ == 3 && __VERSION__ == 300 && GL_ES == 1;
}

//# 3.4 holds the line directive counts lines anew
#line 100
int line = __LINE__;
bool holds() { return line == 100 && __LINE__ == 101; }

//# 3.4 holds the line directive may name a file
#line 7 3
bool holds() { return __LINE__ == 7 && __FILE__ == 3; }

//# 3.4 holds the line directive takes macros
#define HERE 20
#line HERE
bool holds() { return __LINE__ == 20; }

//# 3.4 error the line directive needs a number
#line  //!

//# 3.4 error the line directive needs an integer
#line x  //!

//# 3.4 error the line directive takes two numbers at most
#line 1 2 3  //!

//# 3.4 holds the first branch whose condition holds is taken
#if 0
bool holds() { return false; }
#elif 1
bool holds() { return true; }
#elif 1
bool holds() { return false; }
#else
bool holds() { return false; }
#endif

//# 3.4 holds conditions nest
#if 1
#  if 0
bool holds() { return false; }
#  else
#    ifdef GL_ES
bool holds() { return true; }
#    endif
#  endif
#else
#  error never
#endif

//# 3.4 holds what is skipped need not be GLSL
// glslang looks for the end of the string.
#if 0
@ $ ' " \ ` 0x 09 1.5.6 if while #wrong
#endif
bool holds() { return true; }

//# 3.4 holds conditions inside of what is skipped are not evaluated
#if 0
#if 1 / 0
#elif nonsense(
#endif
#endif
bool holds() { return true; }

//# 3.4 holds conditions after the taken branch are not evaluated
#if 1
bool holds() { return true; }
#elif 1 / 0
#endif

//# 3.4 holds conditions are integer arithmetic
#if 7 / 2 * 2 + 7 % 2 == 7 && (1 << 4 | 1) == 0x11 && ~0 == -1 && 010 == 8
bool holds() { return true; }
#endif

//# 3.4 holds operators bind as in C
#if 1 + 2 * 3 == 7 && 1 | 2 ^ 3 & 2 && !0 + 1 == 2 && 8 >> 1 + 1 == 2
bool holds() { return true; }
#endif

//# 3.4 holds the right side of a decided && is not evaluated
#if 0 && UNKNOWN
#elif 1 || UNKNOWN
bool holds() { return true; }
#endif

//# 3.4 holds macros are expanded in conditions
#define LEVEL (2 + 1)
#if LEVEL > 2 && LEVEL * 2 == 6
bool holds() { return true; }
#endif

//# 3.4 holds defined tests the macro and not its value
#define ZERO 0
#if defined(ZERO) && defined ZERO && !defined(ONE) && !ZERO
bool holds() { return true; }
#endif

//# 3.4 holds ifndef is the other side of ifdef
#ifndef GL_ES
#error GL_ES is defined
#endif
#ifdef NEVER
#error NEVER is not
#endif
bool holds() { return true; }

//# 3.4 E0005 an unknown name is not 0 in a condition
#if UNKNOWN  //!
#endif

//# 3.4 E0005 a condition is needed
#if  //!
#endif

//# 3.4 E0005 a condition has no floats
#if 1.0  //!
#endif

//# 3.4 E0005 nothing is divided by 0 in a condition
#if 1 / 0  //!
#endif

//# 3.4 E0005 nothing is divided by 0 in a condition: the remainder
#if 1 % 0  //!
#endif

//# 3.4 E0005 a condition is one expression
#if 1 1  //!
#endif

//# 3.4 E0005 the parentheses of a condition close
#if (1  //!
#endif

//# 3.4 E0005 conditions have no ?:
#if 1 ? 1 : 0  //!
#endif

//# 3.4 E0005 conditions assign nothing
#define N 1
#if N = 1  //!
#endif

//# 3.4 E0005 defined needs a name
#if defined  //!
#endif

//# 3.4 E0005 defined needs a name, not a number
#if defined(1)  //!
#endif

//# 3.4 E0006 an if ends
#if 1  //!

//# 3.4 E0006 an ifdef ends
#ifdef GL_ES  //!
float x;

//# 3.4 E0006 an endif has its if
#endif  //!

//# 3.4 E0006 an else has its if
#else  //!

//# 3.4 E0006 an elif has its if
#elif 1  //!

//# 3.4 E0006 there is one else
#if 0
#else
#else  //!
#endif

//# 3.4 E0006 no elif follows the else
#if 0
#else
#elif 1  //!
#endif

//# 3.4 E0004 ifdef needs a name
#ifdef  //!
#endif

//# 3.4 E0004 ifndef needs a name, not a number
#ifndef 1  //!
#endif

//# 3.4 E0004 nothing follows the name after ifdef
#ifdef A B  //!
#endif

//# 3.4 E0004 nothing follows endif
#if 1
#endif 1  //!

//# 3.4 E0004 nothing follows else
#if 1
#else 1  //!
#endif

//# 3.4 E0010 an error directive ends the translation
#error this is the message  //!

//# 3.4 holds an error directive that is skipped does nothing
#if 0
#error this is the message
#endif
bool holds() { return true; }

//# 3.4 E0014 a text without a folder includes no file
#include "other.glsl"  //!

//# 3.4 E0003 a directive has a known name
#defien X 1  //!

//# 3.4 E0003 a directive is not a number
#12  //!

//# 3.4 E0009 a directive begins its line
float x; #define X 1  //!

//# 3.4 holds blanks may surround the number sign
  #   define X 2.0
	#	ifdef X
bool holds() { return X == iTime; }
 # endif

//# 3.4 holds a number sign alone is nothing
#
bool holds() { return true; }

//# 3.4 holds a directive may go on in the next line
#define SUM(a, b) a + \
    b
bool holds() { return SUM(1.0, 2.0) == 3.0; }

//# 3.4 holds directives may contain comments
#define X /* one */ 1.0 // and this is no part of it
bool holds() { return X + 1.0 == 2.0; }

//# 3.4 holds a comment may begin inside of a directive and end later
#define X /* this
is all comment */ 1.0
bool holds() { return X == 1.0; }

//# 3.4 holds pragmas that nobody knows are ignored
#pragma toyproof(nothing) at all
#pragma optimize(off)
#pragma debug(on)
bool holds() { return true; }

//# 3.3 holds the version may come first
// On the site, where a header precedes the author's text, it may not; we take whole files, too.
#version 300 es
bool holds() { return __VERSION__ == 300; }

//# 3.3 E0011 the version comes before everything
float x;
#version 300 es  //!

//# 3.3 E0011 other versions are not supported: desktop GLSL
#version 330 core  //!

//# 3.3 E0011 version 300 is es
#version 300  //!

//# 3.3 E0011 ShaderToy does not speak version 100
#version 100  //!

//# 3.5 holds an extension that does not exist may be enabled in vain, before all tokens
// On the site, a header precedes the author's text.
#extension GL_OES_toyproof : enable
bool holds() { return true; }

//# 3.5 error extensions come before all tokens
// glslang lets them.
float x;
#extension GL_OES_toyproof : enable  //!

//# 3.5 holds all extensions may be disabled
// On the site, a header precedes the author's text.
#extension all : disable
bool holds() { return true; }

//# 3.5 E0012 an extension that does not exist cannot be required
#extension GL_OES_toyproof : require  //!

//# 3.5 E0012 not all extensions can be required
#extension all : require  //!

//# 3.5 E0012 not all extensions can be enabled
#extension all : enable  //!

//# 3.5 E0004 an extension has a behaviour
#extension GL_OES_toyproof  //!

//# 3.5 E0004 other behaviors do not exist
#extension GL_OES_toyproof : perhaps  //!

//# 3.4 E0013 macros cannot grow without bounds
// glslang and Chromium lose their patience or memory.
#define A0 +1.0
#define A1 A0 A0 A0 A0 A0 A0 A0 A0
#define A2 A1 A1 A1 A1 A1 A1 A1 A1
#define A3 A2 A2 A2 A2 A2 A2 A2 A2
#define A4 A3 A3 A3 A3 A3 A3 A3 A3
#define A5 A4 A4 A4 A4 A4 A4 A4 A4
#define A6 A5 A5 A5 A5 A5 A5 A5 A5
#define A7 A6 A6 A6 A6 A6 A6 A6 A6
#define A8 A7 A7 A7 A7 A7 A7 A7 A7
float f() {
    return A8;  //!
}

//# 3.4 E0300 an error in a macro is reported where the macro is used
#define HALF(x) x / 2
float f(float a) {
    return HALF(a);  //!
}

//# 3.4 E0200 an error in an argument is reported at the argument
// ANGLE names the last line of the use.
#define SUM(a, b) (a + b)
float f() {
    return SUM(
        1.0,
        oops  //!
    );
}

//# 3.4 E0200 a mistake in a macro that is never used harms nobody, used twice it is told once
#define OOPS (oops + 1.0)
float f() {
    float a = OOPS;  //!
    return a
        + OOPS;
}

//# 3.4 holds a mistake in a macro that is never used harms nobody
#define OOPS (oops + $ 0x)
bool holds() { return true; }
