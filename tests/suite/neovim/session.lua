-- A session of Neovim with the language server, by the functions that its key mappings call. Works with Neovim 0.7
-- and later, without a terminal, with the configuration of the guide:
--
--     SHADER=ball.glsl RESULTS=results.json nvim --headless --clean -u init.lua -n -c 'luafile session.lua'
--
-- Every step waits for its own effect. The results are written as JSON; what a step lacks is null.

local HANG_GUARD = 60000 -- milliseconds

local results = {}

-- Waits until `condition` returns a value that is neither nil nor false; returns that value.
local function wait_for(what, condition)
  local value
  local is_met = vim.wait(HANG_GUARD, function()
    value = condition()
    return value
  end, 10)
  assert(is_met, "waited too long for " .. what)
  return value
end

local function text()
  return table.concat(vim.api.nvim_buf_get_lines(0, 0, -1, true), "\n") .. "\n"
end

-- Moves the cursor to the first character of the nth occurrence of a text, plus some bytes.
local function move_to(part, nth, offset)
  local at = 0
  for _ = 1, nth or 1 do
    at = assert(text():find(part, at + 1, true), part)
  end
  at = at + (offset or 0)
  local before = text():sub(1, at - 1)
  local _, line = before:gsub("\n", "")
  vim.api.nvim_win_set_cursor(0, { line + 1, #before:match("[^\n]*$") })
end

-- The answer to a request about the place of the cursor.
local function request(method, more)
  local parameters = vim.tbl_extend("force", vim.lsp.util.make_position_params(), more or {})
  local answers = assert(vim.lsp.buf_request_sync(0, method, parameters, HANG_GUARD), method)
  local _, answer = next(answers)
  assert(answer and not answer.error, method .. ": " .. vim.inspect(answer))
  return answer.result
end

-- A list stays a list in JSON if it is empty.
local function list(items)
  return #items == 0 and vim.empty_dict() or items
end

local steps = {}

local function clients()
  return (vim.lsp.get_clients or vim.lsp.get_active_clients)()
end

-- The configuration attaches the server when a shader is opened, and the server reports the error.
function steps.open()
  vim.cmd("edit " .. vim.fn.fnameescape(vim.env.SHADER))
  wait_for("the error", function()
    return #vim.diagnostic.get(0) > 0
  end)
  results.clients = vim.tbl_map(function(client)
    return client.name
  end, clients())
  results.errors = vim.tbl_map(function(found)
    return { line = found.lnum + 1, column = found.col + 1, code = found.code, message = found.message }
  end, vim.diagnostic.get(0))
end

-- The first quick fix at the error, chosen from the menu.
function steps.fix()
  vim.ui.select = function(choices, _, choose)
    choose(choices[1], 1)
  end
  local found = vim.diagnostic.get(0)[1]
  vim.api.nvim_win_set_cursor(0, { found.lnum + 1, found.col })
  local before = text()
  vim.lsp.buf.code_action()
  wait_for("the fix", function()
    return text() ~= before
  end)
  results.fixed = text()
  wait_for("no error", function()
    return #vim.diagnostic.get(0) == 0
  end)
end

-- Members offered after `p.`, and the error of the half-typed line.
function steps.complete()
  move_to("Ray ray = ")
  local line = vim.api.nvim_win_get_cursor(0)[1]
  vim.api.nvim_buf_set_lines(0, line - 1, line - 1, true, { "    p." })
  vim.api.nvim_win_set_cursor(0, { line, 5 })
  -- After the dot: a cursor in insert mode may stand behind the last character.
  local parameters = vim.lsp.util.make_position_params()
  parameters.position.character = #"    p."
  local answer = request("textDocument/completion", parameters)
  results.members = list(vim.tbl_map(function(item)
    return item.label
  end, answer.items or answer))
  wait_for("the error of the half-typed line", function()
    return #vim.diagnostic.get(0) > 0
  end)
  vim.api.nvim_buf_set_lines(0, line - 1, line, true, {})
  wait_for("no error again", function()
    return #vim.diagnostic.get(0) == 0
  end)
end

-- The documentation of a built-in function, and the signature of a call.
function steps.read()
  move_to("normalize(")
  local contents = request("textDocument/hover").contents
  results.hover = contents.value
  move_to("intersectBall(ray, 1.0)", 1, #"intersectBall(ray, ")
  local help = request("textDocument/signatureHelp")
  results.signature = help.signatures[(help.activeSignature or 0) + 1].label
  results.active_parameter = help.activeParameter
end

-- From a use to the declaration. The line of the use has a character outside of the Basic Multilingual Plane.
function steps.define()
  move_to("CENTER", 2)
  local from = vim.api.nvim_win_get_cursor(0)
  vim.lsp.buf.definition()
  wait_for("the definition", function()
    return not vim.deep_equal(vim.api.nvim_win_get_cursor(0), from)
  end)
  local cursor = vim.api.nvim_win_get_cursor(0)
  results.definition = { line = cursor[1], column = cursor[2] + 1 }
end

-- All uses of a function get the new name.
function steps.rename()
  move_to("intersectBall", 2)
  local before = text()
  vim.lsp.buf.rename("distanceToBall")
  wait_for("the new name", function()
    return text() ~= before
  end)
  results.renamed = text()
end

function steps.format()
  if vim.lsp.buf.format then
    vim.lsp.buf.format({ async = false, timeout_ms = HANG_GUARD })
  else
    vim.lsp.buf.formatting_sync(nil, HANG_GUARD)
  end
  results.formatted = text()
end

function steps.stop()
  vim.lsp.stop_client(clients())
  wait_for("the end of the server", function()
    return #clients() == 0
  end)
end

local is_done, message = pcall(function()
  for _, step in ipairs({ "open", "fix", "complete", "read", "define", "rename", "format", "stop" }) do
    steps[step]()
  end
end)
if not is_done then
  results.failure = message
end
vim.fn.writefile({ vim.fn.json_encode(results) }, vim.env.RESULTS)
vim.cmd("qall!")
