"""A simple reader of C++ headers: their declarations, and the length of their functions. It matches brackets, not types."""

import re
from dataclasses import dataclass

NOT_CODE = re.compile(
    r'//[^\n]*|/\*.*?\*/|R"(?P<mark>[^(\s]*)\(.*?\)(?P=mark)"|"(?:\\.|[^"\\\n])*"'
    r"|(?<![0-9A-Za-z_])'(?:\\.|[^'\\\n])+'",
    re.DOTALL,
)
DIRECTIVE = re.compile(r"^[ \t]*#(?:[^\n]*\\\n)*[^\n]*", re.MULTILINE)
CLOSES = {"(": ")", "[": "]", "{": "}"}
# Words before a parenthesis that is not a list of parameters.
NOT_A_NAME = {"requires", "noexcept", "decltype", "alignas", "sizeof", "explicit", "throw", "if", "static_assert"}


@dataclass
class Declaration:
    kind: str  # function, class, enum, concept, alias, variable
    name: str  # qualified by the enclosing classes: System::rows
    scopes: tuple  # names of the enclosing namespaces, outermost first
    first: int  # line of its first word
    last: int  # line of its closing brace, or of its semicolon
    parameters: int = 0  # of a function
    body: bool = False  # True for a function with a body
    lines: int = 0  # between the braces of its body
    head: str = ""  # text before its brace or semicolon
    public: bool = True
    friend: bool = False


def blanked(text, what):
    return what.sub(lambda m: re.sub(r"[^\n]", " ", m.group()), text)


def code_of(text):
    """The text with comments, strings, characters and directives blanked; all other letters keep their positions."""
    return blanked(blanked(text, NOT_CODE), DIRECTIVE)


def partners(code):
    """{position of each opening bracket: position of its closing one}, without angle brackets."""
    found, open_ones = {}, []
    for i, c in enumerate(code):
        if c in "([{":
            open_ones.append(i)
        elif c in ")]}":
            if not open_ones or CLOSES[code[open_ones[-1]]] != c:
                raise ValueError(f"line {code.count(chr(10), 0, i) + 1}: '{c}' closes nothing")
            found[open_ones.pop()] = i
    if open_ones:
        raise ValueError(f"line {code.count(chr(10), 0, open_ones[-1]) + 1}: a bracket is not closed")
    return found


def after_angles(text, i):
    """The position after the template list that opens at i."""
    depth, brackets = 0, 0
    while i < len(text):
        c = text[i]
        if c in "([{":
            brackets += 1
        elif c in ")]}":
            brackets -= 1
        elif brackets == 0 and c == "<":
            depth += 1
        elif brackets == 0 and c == ">" and text[i - 1] != "-":
            depth -= 1
            if depth == 0:
                return i + 1
        i += 1
    return len(text)


def after_requires(text, i):
    """The position after the requires-clause whose constraint begins at i: primaries joined by && and ||."""
    while True:
        while i < len(text) and text[i].isspace():
            i += 1
        if text.startswith("requires", i):  # a requires-expression
            i += len("requires")
            while i < len(text) and text[i] != "{":
                i = after_bracket(text, i) if text[i] == "(" else i + 1
            i = after_bracket(text, i)
        elif i < len(text) and text[i] == "(":
            i = after_bracket(text, i)
        else:
            while name := re.compile(r"\s*(?:::)?\s*(?:template\s+)?\w+").match(text, i):
                i = name.end()
                if angle := re.compile(r"\s*<").match(text, i):
                    i = after_angles(text, angle.end() - 1)
                if not re.compile(r"\s*::").match(text, i):
                    break
        joined = re.compile(r"\s*(&&|\|\|)").match(text, i)
        if not joined:
            return i
        i = joined.end()


def after_bracket(text, i):
    """The position after the bracket that opens at i; the end of the text if it is not closed."""
    depth = 0
    for j in range(i, len(text)):
        depth += (text[j] in "([{") - (text[j] in ")]}")
        if depth == 0:
            return j + 1
    return len(text)


def bare(head, friends=False):
    """A declaration without attributes, template lists and their requires-clauses, `inline` and the like. `friend`
    remains if `friends` is true."""
    head = re.sub(r"\[\[[^\]]*\]\]", lambda m: " " * len(m.group()), head).strip()
    while m := re.match(r"template\s*(?=<)", head):
        head = head[after_angles(head, m.end()) :].lstrip()
        if m := re.match(r"requires\b", head):
            head = head[after_requires(head, m.end()) :].lstrip()
    return head if friends else re.sub(r"^(?:friend|extern|inline|static)\s+", "", head)


def top_level(head):
    """The head with the content of brackets and angle brackets blanked, the brackets themselves kept; operators become words."""
    head = re.sub(r"\boperator\s*(\(\s*\)|\[\s*\]|[-+*/%^&|~!=<>,]+)", lambda m: "operator" + "_" * len(m.group(1)), head)
    out, stack, angle = [], 0, 0
    for i, c in enumerate(head):
        before = head[i - 1] if i else " "
        if c in ")]}":
            stack -= 1
        if stack == 0 and angle == 0 and c in "()[]{}":
            out.append(c)
        elif stack == 0 and c == "<" and before not in "<=" and head[i + 1 : i + 2] not in ("<", "="):
            angle += 1
            out.append(" ")
        elif stack == 0 and angle and c == ">" and before != "-":
            angle -= 1
            out.append(" ")
        else:
            out.append(c if stack == 0 and angle == 0 else " ")
        if c in "([{":
            stack += 1
    return head, "".join(out)


def parameter_list(head):
    """(name, position of the opening parenthesis in `words`, words, top) of a function's head; None without a parameter list."""
    words, top = top_level(bare(head))
    for m in re.finditer(r"((?:~\s*)?\w+)\s*\(", top):
        if m[1] not in NOT_A_NAME:
            # the qualified name: Model<Bodies<Bs...>>::add
            before = re.search(r"((?:\w+\s*::\s*)*)$", re.sub(r"\s*(?=::)", "", top[: m.start()]))
            name = re.sub(r"\s", "", before[1] + m[1])
            if re.fullmatch("operator_+", name):
                name = re.sub(r"\s", "", re.search(r"operator\s*(\(\s*\)|\[\s*\]|[^\w\s(]+)", bare(head))[0])
            elif conversion := re.search(r"\boperator\s+(\w+)\s*$", top[: m.end() - 1]):
                name = f"operator {conversion[1]}"
            return name, m.end() - 1, words, top
    return None


def count_parameters(words, at):
    inside = words[at + 1 : after_bracket(words, at) - 1].strip()
    if inside in ("", "void"):
        return 0
    inside = inside.replace("->", "  ")
    return 1 + top_level(inside)[1].count(",")


def is_requires_expression(head):
    """True if the brace after this head opens a requires-expression."""
    if re.search(r"\brequires\s*$", head):
        return True
    if not head.rstrip().endswith(")"):
        return False
    end = len(head.rstrip()) - 1
    depth = 0
    for i in range(end, -1, -1):
        depth += (head[i] == ")") - (head[i] == "(")
        if depth == 0:
            break
    m = re.search(r"(\S*)\s*\brequires\s*$", head[:i])
    return bool(m) and (m[1].endswith(("requires", "=", "&&", "||", "!", "(")))


def opens(head):
    """Kind of the brace after this head: namespace, class, enum, function, or nothing that is read (an initialiser)."""
    if is_requires_expression(head):
        return "expression"
    plain = bare(head)
    if re.match(r"(inline\s+)?namespace\b|extern\s*$|^$", plain):
        return "namespace"
    if re.match(r"(class|struct|union)\b", plain) and "=" not in top_level(plain)[1]:
        return "class"
    if re.match(r"enum\b", plain):
        return "enum"
    found = parameter_list(head)
    if not found:
        return "initialiser"
    _, at, words, top = found
    if re.search(r"(?<![=!<>])=(?!=)", top[:at]):
        return "initialiser"
    rest = top[after_bracket(words, at) :]
    if re.search(r"(?<!:):(?!:)", rest) and re.search(r"[\w>]\s*$", words):  # an entry of a constructor's initialiser list
        return "initialiser"
    return "function"


def declarations(text):
    """Every declaration of namespaces and classes in a header, in order; bodies are not read."""
    code = code_of(text)
    partner = partners(code)
    line = lambda i: code.count("\n", 0, i) + 1

    def simple(head):
        """Kind and name of a declaration that ends with a semicolon."""
        plain = bare(head)
        if m := re.match(r"using\s+(\w+)\s*=|concept\s+(\w+)", plain):
            return ("alias" if m[1] else "concept"), m[1] or m[2]
        if re.match(r"(using|static_assert|namespace|template|typedef)\b|$", plain):
            return None
        if m := re.match(r"(?:class|struct|union|enum(?:\s+class)?)\s+(\w+)\s*(:.*)?$", plain, re.DOTALL):
            return "class", m[1]
        found = parameter_list(head)
        if found and not re.search(r"(?<![=!<>])=(?!=)", found[3][: found[1]]):
            return "function", found[0], count_parameters(found[2], found[1])
        top = re.sub(r"\{.*", "", re.split(r"(?<![=!<>])=(?!=)", top_level(plain)[1])[0])
        m = re.search(r"(\w+)\s*(\[\s*\])*\s*$", top)
        return ("variable", m[1]) if m else None

    def scan(i, end, scopes, classes, public):
        start = None
        while i < end:
            c = code[i]
            if c.isspace():
                i += 1
                continue
            if start is None:
                start = i
            at = lambda kind, name, last, **more: Declaration(
                kind, "::".join((*classes, name)), scopes, line(start), line(last), public=public, head=code[start:i],
                friend=bool(re.match(r"friend\b", bare(code[start:i], friends=True))), **more)
            if c in "([":
                i = partner[i] + 1
                continue
            if c == ";":
                if what := simple(code[start:i]):
                    yield at(what[0], what[1], i, parameters=what[2] if len(what) > 2 else 0)
                start = None
            elif c == ":" and (label := re.fullmatch(r"(public|protected|private)\s*", code[start:i])):
                public = label[1] == "public"
                start = None
            elif c == "{":
                head, close = code[start:i], partner[i]
                kind = opens(head)
                if kind == "namespace":
                    name = re.search(r"namespace\s+([\w:]+)", head)
                    yield from scan(i + 1, close, scopes + tuple(name[1].split("::") if name else ()), classes, True)
                    start = None
                elif kind == "class":
                    said = re.match(r"\w+\s*(?:alignas\s*\(\s*\)\s*)?((?:\w+\s*::\s*)*)(\w+)?", top_level(bare(head))[1])
                    name = said[2] or "(unnamed)"
                    yield at("class", name, close)
                    yield from scan(i + 1, close, scopes, (*classes, name), not bare(head).startswith("class"))
                    start = None
                elif kind == "function":
                    name, place, words, _ = parameter_list(head)
                    yield at("function", name, close, parameters=count_parameters(words, place), body=True,
                             lines=max(line(close) - line(i) - 1, 0))
                    start = None
                elif kind == "enum":
                    yield at("enum", re.match(r"enum\b\s*(?:class\s+|struct\s+)?(\w*)", bare(head))[1] or "(unnamed)", close)
                    start = None
                i = close
            i += 1

    yield from scan(0, len(code), (), (), True)
