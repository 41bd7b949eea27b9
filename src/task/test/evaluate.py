#!/usr/bin/python3
"""evaluate.py FILE: evaluates expressions as Python reads them, for expression_test.cpp.

The first line of FILE has the names; each further line has their values and, after a tab, the expression. Prints the
value of each, in that form. Precedence and chaining are Python's; where Python raises an error, an IEEE 754 number takes
its place.
"""
import ast
import math
import sys

NAN, INF = math.nan, math.inf


def whole(function):
    return lambda x: math.copysign(function(x), x) if math.isfinite(x) else x  # -0.5 becomes -0


def or_nan(function):
    def call(*arguments):
        try:
            return function(*arguments)
        except ValueError:
            return NAN
    return call


def divide(a, b):
    if b != 0:
        return a / b
    return NAN if a == 0 or math.isnan(a) else math.copysign(INF, a) * math.copysign(1, b)


def power(a, b):
    odd = b % 2 == 1 if math.isfinite(b) else False
    try:
        return math.pow(a, b)
    except OverflowError:
        return -INF if a < 0 and odd else INF
    except ValueError:
        if a != 0:
            return NAN
        return math.copysign(INF, a) if odd else INF


def exponential(x):
    try:
        return math.exp(x)
    except OverflowError:
        return INF


def rounded(x):
    below = math.floor(abs(x))
    return math.copysign(below + (abs(x) - below >= 0.5), x)


def clamp(x, low, high):
    x = low if low > x else x
    return high if high < x else x


FUNCTIONS = {
    "divide": divide, "power": power, "modulo": lambda a, b: a % b if b != 0 else NAN,
    "abs": abs, "min": min, "max": max, "clamp": clamp, "hypot": math.hypot, "atan2": math.atan2,
    "sqrt": or_nan(math.sqrt), "exp": exponential,
    "log": lambda x: -INF if x == 0 else or_nan(math.log)(x),
    "sin": or_nan(math.sin), "cos": or_nan(math.cos), "tan": or_nan(math.tan),
    "floor": whole(math.floor), "ceil": whole(math.ceil), "round": whole(rounded),
    "sign": lambda x: float((x > 0) - (x < 0)),
}


class Ieee(ast.NodeTransformer):
    """Puts functions that raise no error in the place of operators, and makes each number a float."""

    INSTEAD = {ast.Div: "divide", ast.Pow: "power", ast.Mod: "modulo"}

    def visit_BinOp(self, node):
        self.generic_visit(node)
        name = self.INSTEAD.get(type(node.op))
        if name is None:
            return node
        return ast.Call(func=ast.Name(id=name, ctx=ast.Load()), args=[node.left, node.right], keywords=[])

    def visit_Constant(self, node):
        return ast.Constant(value=float(node.value))


def main():
    with open(sys.argv[1], encoding="utf-8") as file:
        names = file.readline().split()
        for line in file:
            values, text = line.rstrip("\n").split("\t")
            scope = dict(zip(names, map(float, values.split())), **FUNCTIONS)
            tree = Ieee().visit(ast.parse(text.replace("^", "**"), mode="eval"))
            value = eval(compile(ast.fix_missing_locations(tree), text, "eval"), {"__builtins__": {}}, scope)
            print(repr(float(value)))


main()
