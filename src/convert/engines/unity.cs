using System;
using System.Collections.Generic;
using UnityEngine;

namespace ShaderToy.$name
{
    /// <summary>
    /// Plays the passes of a ShaderToy shader, and shows the image on the whole screen. Each buffer has two
    /// textures, which take turns: one is rendered, the other has the previous frame.
    /// </summary>
    public class ShaderToyPlayer : MonoBehaviour
    {
        /// <summary>The passes, in the order in which they are rendered.</summary>
        const string GraphText = @"$graph";

        // JsonUtility sets these fields.
#pragma warning disable 0649
        [Serializable]
        class Graph
        {
            public Pass[] passes;
        }

        [Serializable]
        class Pass
        {
            public string target;
            public bool mipmaps;
            public Channel[] inputs;
        }

        [Serializable]
        class Channel
        {
            public string source;
            public string buffer;
            public string frame;
            public string id;
            public string type;
        }
#pragma warning restore 0649

        [Serializable]
        public class Medium
        {
            public string id;
            public Texture texture;
        }

        /// <summary>The shaders of the passes, in the order of the graph.</summary>
        public Shader[] shaders;

        /// <summary>The textures that channels read, by the id in the graph.</summary>
        public List<Medium> media = new List<Medium>();

        readonly Dictionary<string, RenderTexture[]> buffers = new Dictionary<string, RenderTexture[]>();
        Graph graph;
        Material[] materials;
        RenderTexture image;
        RenderTexture zero;
        Texture2D black;
        Texture2D keyboard;
        Vector4 mouse;
        int frame;

        void Start()
        {
            graph = JsonUtility.FromJson<Graph>(GraphText);
            if (shaders == null || shaders.Length != graph.passes.Length || Array.Exists(shaders, shader => shader == null))
            {
                Debug.LogError("ShaderToyPlayer: assign the shaders of the " + graph.passes.Length + " passes, in order");
                enabled = false;
                return;
            }
#if ENABLE_INPUT_SYSTEM && !ENABLE_LEGACY_INPUT_MANAGER
            Debug.LogWarning("ShaderToyPlayer: set Active Input Handling to Both; OnGUI gets no mouse and no keys otherwise");
#endif
            materials = Array.ConvertAll(shaders, shader => new Material(shader));
            keyboard = new Texture2D(256, 3, TextureFormat.R8, false, true);
            keyboard.SetPixels32(new Color32[256 * 3]);
            black = new Texture2D(1, 1, TextureFormat.RGBA32, false, true);
            black.SetPixel(0, 0, Color.black);
            black.Apply();
        }

        void OnDestroy()
        {
            foreach (RenderTexture[] turns in buffers.Values)
            {
                Array.ForEach(turns, Discard);
            }
            Discard(image);
            Discard(zero);
            Destroy(keyboard);
            Destroy(black);
            if (materials != null)
            {
                Array.ForEach(materials, Destroy);
            }
        }

        static void Discard(RenderTexture texture)
        {
            if (texture != null)
            {
                texture.Release();
                Destroy(texture);
            }
        }

        /// <summary>A texture of the screen's size with the lower left part of another, and zeros elsewhere.</summary>
        static RenderTexture Resized(RenderTexture old, RenderTextureFormat format, bool mipmaps)
        {
            var texture = new RenderTexture(Screen.width, Screen.height, 0, format)
            {
                useMipMap = mipmaps,
                autoGenerateMips = false,
            };
            RenderTexture active = RenderTexture.active;
            RenderTexture.active = texture;
            GL.Clear(false, true, Color.clear);
            RenderTexture.active = active;
            if (old != null)
            {
                int width = Mathf.Min(old.width, texture.width);
                int height = Mathf.Min(old.height, texture.height);
                Graphics.CopyTexture(old, 0, 0, 0, 0, width, height, texture, 0, 0, 0, 0);
                Discard(old);
            }
            if (mipmaps)
            {
                texture.GenerateMips();
            }
            return texture;
        }

        void Resize()
        {
            image = Resized(image, RenderTextureFormat.Default, false);
            zero = Resized(zero, RenderTextureFormat.ARGBFloat, false);
            foreach (Pass pass in graph.passes)
            {
                if (pass.target != "image")
                {
                    RenderTexture[] old;
                    if (!buffers.TryGetValue(pass.target, out old))
                    {
                        old = new RenderTexture[2];
                    }
                    buffers[pass.target] = Array.ConvertAll(old, side => Resized(side, RenderTextureFormat.ARGBFloat, pass.mipmaps));
                }
            }
        }

        void Update()
        {
            if (image == null || image.width != Screen.width || image.height != Screen.height)
            {
                Resize();
            }
            keyboard.Apply();
            DateTime now = DateTime.Now;
            var date = new Vector4(now.Year, now.Month - 1, now.Day, (float)now.TimeOfDay.TotalSeconds);
            int turn = frame % 2;
            for (int number = 0; number < materials.Length; number++)
            {
                Pass pass = graph.passes[number];
                Material material = materials[number];
                material.SetVector("outputSize", new Vector4(image.width, image.height));
                material.SetInteger("iFrame", frame);
                material.SetVector("iMouse", mouse);
                material.SetVector("iDate", date);
                for (int channel = 0; channel < 4; channel++)
                {
                    Texture texture = Read(pass.inputs[channel], turn);
                    if (texture != null)
                    {
                        material.SetTexture("iChannel" + channel, texture);
                    }
                }
                RenderTexture target = pass.target == "image" ? image : buffers[pass.target][turn];
                Graphics.Blit(null, target, material);
                if (pass.mipmaps)
                {
                    target.GenerateMips();
                }
            }
            frame++;
            mouse.w = -Mathf.Abs(mouse.w);
            for (int key = 0; key < 256; key++)
            {
                keyboard.SetPixel(key, 1, Color.clear);
            }
        }

        /// <summary>What a channel reads; null for the default texture of the shader's property.</summary>
        Texture Read(Channel input, int turn)
        {
            switch (input?.source)
            {
                case "buffer":
                    RenderTexture[] turns;
                    int rendered = input.frame == "this" ? turn : 1 - turn;
                    return buffers.TryGetValue(input.buffer, out turns) ? turns[rendered] : zero;
                case "keyboard":
                    return keyboard;
                case "media":
                    Medium medium = media.Find(candidate => candidate.id == input.id);
                    bool isFlat = input.type != "cubemap" && input.type != "volume";
                    return medium != null && medium.texture != null ? medium.texture : isFlat ? black : null;
                default:
                    return black;
            }
        }

        void OnGUI()
        {
            Event now = Event.current;
            if (now.isMouse && now.button != 0)
            {
                return;
            }
            // The click is positive while the button is down, and its y in the first frame.
            var at = new Vector2(now.mousePosition.x, Screen.height - now.mousePosition.y);
            switch (now.type)
            {
                case EventType.MouseDown:
                    mouse = new Vector4(at.x, at.y, at.x, at.y);
                    break;
                case EventType.MouseDrag:
                    mouse.x = at.x;
                    mouse.y = at.y;
                    break;
                case EventType.MouseUp:
                    mouse.z = -Mathf.Abs(mouse.z);
                    break;
                case EventType.KeyDown:
                case EventType.KeyUp:
                    Key(now.keyCode, now.type == EventType.KeyDown);
                    break;
                case EventType.Repaint:
                    if (image != null)
                    {
                        GUI.DrawTexture(new Rect(0, 0, Screen.width, Screen.height), image, ScaleMode.StretchToFill, false);
                    }
                    break;
            }
        }

        void Key(KeyCode key, bool isDown)
        {
            int code = CodeOf(key);
            if (code < 0 || isDown == keyboard.GetPixel(code, 0).r > 0.5f)
            {
                return;
            }
            keyboard.SetPixel(code, 0, isDown ? Color.red : Color.clear);
            if (isDown)
            {
                keyboard.SetPixel(code, 1, Color.red);
                keyboard.SetPixel(code, 2, keyboard.GetPixel(code, 2).r > 0.5f ? Color.clear : Color.red);
            }
        }

        /// <summary>The key code of JavaScript; -1 for a key that has none.</summary>
        static int CodeOf(KeyCode key)
        {
            if (key >= KeyCode.A && key <= KeyCode.Z)
            {
                return key - KeyCode.A + 65;
            }
            if (key >= KeyCode.Keypad0 && key <= KeyCode.Keypad9)
            {
                return key - KeyCode.Keypad0 + 96;
            }
            if (key >= KeyCode.F1 && key <= KeyCode.F12)
            {
                return key - KeyCode.F1 + 112;
            }
            if (key >= KeyCode.Alpha0 && key <= KeyCode.Alpha9)
            {
                return (int)key;
            }
            switch (key)
            {
                // The same codes as in JavaScript.
                case KeyCode.Backspace:
                case KeyCode.Tab:
                case KeyCode.Return:
                case KeyCode.Pause:
                case KeyCode.Escape:
                case KeyCode.Space:
                    return (int)key;
                case KeyCode.KeypadEnter:
                    return 13;
                case KeyCode.LeftShift:
                case KeyCode.RightShift:
                    return 16;
                case KeyCode.LeftControl:
                case KeyCode.RightControl:
                    return 17;
                case KeyCode.LeftAlt:
                case KeyCode.RightAlt:
                    return 18;
                case KeyCode.CapsLock:
                    return 20;
                case KeyCode.PageUp:
                    return 33;
                case KeyCode.PageDown:
                    return 34;
                case KeyCode.End:
                    return 35;
                case KeyCode.Home:
                    return 36;
                case KeyCode.LeftArrow:
                    return 37;
                case KeyCode.UpArrow:
                    return 38;
                case KeyCode.RightArrow:
                    return 39;
                case KeyCode.DownArrow:
                    return 40;
                case KeyCode.Insert:
                    return 45;
                case KeyCode.Delete:
                    return 46;
                case KeyCode.Semicolon:
                    return 186;
                case KeyCode.Equals:
                    return 187;
                case KeyCode.Comma:
                    return 188;
                case KeyCode.Minus:
                    return 189;
                case KeyCode.Period:
                    return 190;
                case KeyCode.Slash:
                    return 191;
                case KeyCode.BackQuote:
                    return 192;
                case KeyCode.LeftBracket:
                    return 219;
                case KeyCode.Backslash:
                    return 220;
                case KeyCode.RightBracket:
                    return 221;
                case KeyCode.Quote:
                    return 222;
                default:
                    return -1;
            }
        }
    }
}
