using System;
using System.Collections.Generic;
using UnityEngine;

/// <summary>
/// Plays the passes of a ShaderToy shader, and shows the image on the whole screen. Each buffer has two
/// textures, which take turns: one is rendered, the other has the previous frame.
/// </summary>
public class ShaderToyPlayer : MonoBehaviour
{
    /// <summary>The passes, in the order in which they are rendered.</summary>
    const string GraphText = @"$graph";

    [Serializable]
    class Graph
    {
        public Pass[] passes;
    }

    [Serializable]
    class Pass
    {
        public string file;
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
    }

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
    Texture2D keyboard;
    Vector4 mouse;
    int frame;

    void Start()
    {
        graph = JsonUtility.FromJson<Graph>(GraphText);
        if (shaders == null || shaders.Length != graph.passes.Length)
        {
            Debug.LogError("ShaderToyPlayer: assign the shaders of the " + graph.passes.Length + " passes, in order");
            enabled = false;
            return;
        }
        materials = Array.ConvertAll(shaders, shader => new Material(shader));
        keyboard = new Texture2D(256, 3, TextureFormat.R8, false, true);
        keyboard.SetPixels32(new Color32[256 * 3]);
    }

    void OnDestroy()
    {
        Release();
    }

    void Release()
    {
        foreach (RenderTexture[] turns in buffers.Values)
        {
            Array.ForEach(turns, texture => texture.Release());
        }
        buffers.Clear();
        if (image != null)
        {
            image.Release();
        }
    }

    RenderTexture Zero(RenderTextureFormat format, bool mipmaps)
    {
        var texture = new RenderTexture(Screen.width, Screen.height, 0, format)
        {
            useMipMap = mipmaps,
            autoGenerateMips = false,
        };
        RenderTexture.active = texture;
        GL.Clear(false, true, Color.clear);
        RenderTexture.active = null;
        return texture;
    }

    void Resize()
    {
        Release();
        image = Zero(RenderTextureFormat.Default, false);
        foreach (Pass pass in graph.passes)
        {
            if (pass.target != "image")
            {
                buffers[pass.target] = new[]
                {
                    Zero(RenderTextureFormat.ARGBFloat, pass.mipmaps),
                    Zero(RenderTextureFormat.ARGBFloat, pass.mipmaps),
                };
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
                material.SetTexture("iChannel" + channel, Read(pass.inputs[channel], turn));
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

    Texture Read(Channel input, int turn)
    {
        switch (input?.source)
        {
            case "buffer":
                RenderTexture[] turns;
                int rendered = input.frame == "this" ? turn : 1 - turn;
                return buffers.TryGetValue(input.buffer, out turns) ? turns[rendered] : Texture2D.blackTexture;
            case "keyboard":
                return keyboard;
            case "media":
                Medium medium = media.Find(candidate => candidate.id == input.id);
                return medium != null && medium.texture != null ? medium.texture : Texture2D.blackTexture;
            default:
                return Texture2D.blackTexture;
        }
    }

    void OnGUI()
    {
        Event now = Event.current;
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
        if (code < 0 || code > 255 || isDown == keyboard.GetPixel(code, 0).r > 0.5f)
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

    /// <summary>The key code of JavaScript.</summary>
    static int CodeOf(KeyCode key)
    {
        switch (key)
        {
            case KeyCode.LeftArrow:
                return 37;
            case KeyCode.UpArrow:
                return 38;
            case KeyCode.RightArrow:
                return 39;
            case KeyCode.DownArrow:
                return 40;
            case KeyCode.LeftShift:
            case KeyCode.RightShift:
                return 16;
            case KeyCode.LeftControl:
            case KeyCode.RightControl:
                return 17;
            case KeyCode.Delete:
                return 46;
            default:
                return key >= KeyCode.A && key <= KeyCode.Z ? key - KeyCode.A + 65 : (int)key;
        }
    }
}
